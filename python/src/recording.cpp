// Parts of carom.Recorder: samples of a run, and the types of their rows.

#include "bind.h"
#include "sampler.h"

#include <cstddef>

namespace carom_python {

using namespace carom;

namespace {

/// Fields of a row as numpy.dtype takes them.
class RowType {
public:
  void add(const char* name, const std::string& format, std::size_t offset) {
    names_.append(name);
    formats_.append(nb::str(format.c_str()));
    offsets_.append(offset);
  }
  [[nodiscard]] nb::dict get(std::size_t size) const {
    nb::dict type;
    type["names"] = names_;
    type["formats"] = formats_;
    type["offsets"] = offsets_;
    type["itemsize"] = size;
    return type;
  }

private:
  nb::list names_, formats_, offsets_;
};

template <int D>
nb::dict row_types() {
  using Contact = ContactRow<D>;
  using Event = EventRow<D>;
  const std::string vector = "(" + std::to_string(D) + ",)f8";
  RowType contact;
  contact.add("point", vector, offsetof(Contact, point));
  contact.add("normal", vector, offsetof(Contact, normal));
  contact.add("impulse", vector, offsetof(Contact, impulse));
  contact.add("gap", "f8", offsetof(Contact, gap));
  contact.add("name", "i4", offsetof(Contact, name));
  contact.add("mode", "u1", offsetof(Contact, mode));
  contact.add("impact", "u1", offsetof(Contact, impact));
  RowType event;
  event.add("time", "f8", offsetof(Event, time));
  event.add("instant", "i8", offsetof(Event, instant));
  event.add("point", vector, offsetof(Event, point));
  event.add("normal", vector, offsetof(Event, normal));
  event.add("impulse", vector, offsetof(Event, impulse));
  event.add("velocity_before", vector, offsetof(Event, velocity_before));
  event.add("velocity_after", vector, offsetof(Event, velocity_after));
  event.add("gap", "f8", offsetof(Event, gap));
  event.add("energy_before", "f8", offsetof(Event, energy_before));
  event.add("energy_after", "f8", offsetof(Event, energy_after));
  event.add("name", "i4", offsetof(Event, name));
  event.add("kind", "u1", offsetof(Event, kind));
  event.add("mode", "u1", offsetof(Event, mode));
  nb::dict types;
  types["contacts"] = contact.get(sizeof(Contact));
  types["events"] = event.get(sizeof(Event));
  return types;
}

/// The sampler of Python: observes from the first call of attach() to detach().
struct Attached {
  std::shared_ptr<Sampler> sampler;
  CallbackId callback;
};

Attached attach(Runner& runner, nb::handle interval, bool contacts, std::size_t frames, double seconds,
                nb::handle full, nb::handle names, double last, std::int64_t instant) {
  SamplerOptions options;
  options.instant = instant;
  options.last = last;
  options.interval = read<double>(interval, "Recorder: argument 'interval'");
  options.contacts = contacts;
  options.frames = frames;
  options.seconds = seconds;
  options.full = Shared(nb::borrow(full));
  options.names = read<std::vector<std::string>>(names, "Recorder: names");
  Attached made{std::make_shared<Sampler>(runner, std::move(options)), {}};
  made.callback = runner.get().observe(
      [sampler = made.sampler](const Simulation& simulation) { sampler->observe(simulation); });
  return made;
}

}  // namespace

void bind_recording(nb::module_& core) {
  nb::class_<Attached>(core, "_Sampler", "Samples of a run; carom.Recorder keeps them.")
      .def(
          "__init__",
          [](Attached* self, Runner& runner, nb::handle interval, bool contacts, std::size_t frames,
             double seconds, nb::handle full, nb::handle names, double last, std::int64_t instant) {
            new (self)
                Attached(attach(runner, interval, contacts, frames, seconds, full, names, last, instant));
          },
          nb::arg("simulation"), nb::arg("interval"), nb::arg("contacts"), nb::arg("frames"),
          nb::arg("seconds"), nb::arg("full").none(), nb::arg("names"), nb::arg("last"), nb::arg("instant"))
      .def(
          "sample", [](Attached& self, Runner& runner) { self.sampler->sample(runner.get()); },
          nb::arg("simulation"), "A sample now.")
      .def(
          "take", [](Attached& self) { return self.sampler->take(); },
          nb::sig("def take(self) -> dict[str, typing.Any]"),
          "What was sampled since the last call: arrays by name.")
      .def(
          "detach", [](Attached& self, Runner& runner) { runner.get().remove_callback(self.callback); },
          nb::arg("simulation"), "Ends the sampling.")
      .def(
          "last", [](Attached& self) { return self.sampler->last(); }, "Time of the last sample [s].")
      .def(
          "moved", [](Attached& self) { return Convert<std::vector<Index>>::cast(self.sampler->moved()); },
          nb::sig("def moved(self) -> list[int]"), "Serial numbers of the moved shapes on ground.");
  core.def(
      "_row_types", [](int dimension) { return dimension == 3 ? row_types<3>() : row_types<2>(); },
      nb::arg("dimension"), nb::sig("def _row_types(dimension: int) -> dict[str, typing.Any]"),
      "Types of the rows of contacts and events, as numpy.dtype takes them.");
}

}  // namespace carom_python

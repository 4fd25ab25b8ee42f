#pragma once

// Descriptions of structs: from one list of fields come the constructor with keywords, the properties, the
// table of fields that scene files and their schema are made of, and the texts of help().

#include "convert.h"

#include <cstddef>
#include <deque>
#include <string>
#include <type_traits>
#include <typeinfo>
#include <vector>

namespace carom_python {

/// Text of the C++ documentation: of a type, "Type.member" or a function; empty if there is none.
[[nodiscard]] const char* doc(const std::string& key);

/// Reads and shows fields of one type, without the type.
struct FieldType {
  TypeNames names;
  void (*load)(nb::handle from, void* to, std::string_view where) = nullptr;
  nb::object (*cast)(const void* from) = nullptr;
  bool (*is_python)(const void* value) = nullptr;
};

template <class T>
const FieldType& field_type() {
  static const FieldType type = [] {
    FieldType made;
    made.names = Convert<T>::names();
    if constexpr (requires(nb::handle h, T & t, std::string_view w) { Convert<T>::load(h, t, w); }) {
      made.load = [](nb::handle from, void* to, std::string_view where) {
        Convert<T>::load(from, *static_cast<T*>(to), where);
      };
    }
    made.cast = [](const void* from) { return Convert<T>::cast(*static_cast<const T*>(from)); };
    if constexpr (requires(const T& t) { Convert<T>::is_python(t); }) {
      made.is_python = [](const void* value) { return Convert<T>::is_python(*static_cast<const T*>(value)); };
    }
    return made;
  }();
  return type;
}

/// One field.
struct Field {
  std::string name;
  std::ptrdiff_t offset = 0;
  const FieldType* type = nullptr;
  bool required = false;
  std::string doc, unit;
  std::string argument;      ///< as messages name it: "Particle: argument 'mass'"
  nb::handle default_value;  ///< shown in signatures; lives as long as the program

  /// Its name in Python, where `from` and `with` are words of the language.
  [[nodiscard]] std::string python() const { return name == "from" || name == "with" ? name + "_" : name; }

  [[nodiscard]] void* of(void* record) const { return static_cast<char*>(record) + offset; }
  [[nodiscard]] const void* of(const void* record) const { return static_cast<const char*>(record) + offset; }
};

/// One struct: its name in Python, the module it is in, its fields.
struct Record {
  std::string name, module, doc;
  std::string role;                  ///< of a part: "body", "element", ...; "" of others
  std::vector<std::string> structs;  ///< names in C++: its own, those of its bases
  std::deque<Field> fields;
  nb::handle type;
  bool writable = true;

  /// Sets fields from arguments. Raises TypeError naming the field.
  void set(void* record, const nb::args& given, const nb::kwargs& named) const;
  /// Sets fields from a dictionary of them by name. Raises TypeError naming the field.
  void set_from(void* record, const nb::dict& named, std::string_view where) const;
  /// Field of that name, in C++ or in Python; null if none.
  [[nodiscard]] const Field* find(std::string_view field) const;
  /// Names of the fields in Python.
  [[nodiscard]] std::vector<std::string> field_names() const;
  /// "RigidBody(mass=..., angle=0.5)": fields that are not as by default.
  [[nodiscard]] std::string text(const void* record) const;
  /// Signature of the constructor.
  [[nodiscard]] std::string signature() const;
};

/// All that are bound, in their order.
[[nodiscard]] std::vector<Record*>& records();
/// That of a Python type, null if none.
[[nodiscard]] const Record* record_of(nb::handle type);

constexpr bool required = true;

/// Lists the fields of a struct.
template <class P>
class Fields {
public:
  explicit Fields(Record& record) : record_(&record) {}

  /// Adds a field. \param key name of its text; that of the struct and the field if not given
  template <class T, class B>
  Fields& operator()(const char* name, T B::*member, bool is_required = false) {
    static const P defaults{};
    const auto* start = reinterpret_cast<const char*>(&defaults);
    Field field;
    field.name = name;
    field.offset = reinterpret_cast<const char*>(&(defaults.*member)) - start;
    field.type = &field_type<T>();
    field.required = is_required;
    record_->fields.push_back(std::move(field));
    return *this;
  }

private:
  Record* record_;
};

/// Fills in texts, defaults and properties, once the class is made. \param keys names of texts of the struct
void finish_record(Record& record, nb::handle type, const std::vector<std::string>& keys,
                   const void* defaults);

/// Binds a struct that is described by a list of fields. \param doc_keys types in whose texts its fields are,
/// its own first \param describe lists the fields
template <class P, class Describe>
nb::class_<P> bind_record(nb::module_& module, const char* name, const std::vector<std::string>& doc_keys,
                          bool writable, const Describe& describe) {
  static Record record;
  record.name = name;
  record.module = nb::cast<std::string>(module.attr("__name__"));
  record.doc = doc(doc_keys.front());
  record.writable = writable;
  record.structs = doc_keys;
  Fields<P> fields(record);
  describe(fields);
  nb::class_<P> type(module, name, record.doc.c_str());
  static const P defaults{};
  finish_record(record, type, doc_keys, &defaults);
  if (writable) {
    static const std::string signature = record.signature();
    type.def(
        "__init__",
        [](P* self, const nb::args& given, const nb::kwargs& named) {
          P made{};
          record.set(&made, given, named);
          new (self) P(std::move(made));
        },
        nb::sig(signature.c_str()));
  }
  type.def("__copy__", [](const P& self) { return P(self); });
  type.def("__repr__", [](const P& self) { return record.text(&self); });
  return type;
}

/// Bound structs as fields of others. One that has a constructor may be given as a dictionary of its fields.
template <class P>
struct BoundRecord {
  static TypeNames names() {
    const nb::handle type = nb::type<P>();
    const std::string name =
        nb::cast<std::string>(type.attr("__module__")) + "." + nb::cast<std::string>(type.attr("__name__"));
    return {made_of_dictionaries() != nullptr ? name + " | dict[str, typing.Any]" : name, name,
            "record " + name};
  }
  static void load(nb::handle from, P& to, std::string_view where) {
    const Record* const record = made_of_dictionaries();
    if (record == nullptr || PyDict_Check(from.ptr()) == 0) {
      to = *static_cast<P*>(load_instance(from, typeid(P), where, names().gives));
      return;
    }
    P made{};
    record->set_from(&made, nb::borrow<nb::dict>(from), where);
    to = std::move(made);
  }
  static nb::object cast(const P& value) { return nb::cast(value, nb::rv_policy::copy); }

private:
  static const Record* made_of_dictionaries() {
    const Record* const record = record_of(nb::type<P>());
    return record != nullptr && record->writable ? record : nullptr;
  }
};

}  // namespace carom_python

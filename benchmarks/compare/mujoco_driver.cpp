// The scenes in MuJoCo (https://mujoco.org): joint coordinates and soft contact, without a coefficient of
// restitution. Each contact is given the stiffness and damping with which a lone body leaves it at e_n times
// the speed of approach; a rebound takes a stated number of steps.

#include "rigid_world.h"

#include <mujoco/mujoco.h>

#include <cstring>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace compare {
namespace {

constexpr double steps_of_rebound = 10.0;

/// Damping ratio of a linear spring with dashpot, parted where its force falls to zero, that returns a part e
/// of the speed (T. Schwager, T. Poeschel, Granular Matter 9, 2007, 465).
double damping_ratio(double e) {
  const auto returned = [](double zeta) {
    const double root = std::sqrt(1.0 - zeta * zeta);
    const double angle = std::atan2(2.0 * zeta * root, 1.0 - 2.0 * zeta * zeta);
    return std::exp(-zeta / root * (std::numbers::pi - angle));
  };
  double low = 0.0, high = 0.999;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (returned(middle) > e ? low : high) = middle;
  }
  return low;
}

/// Acceleration of a contact by its depth and speed, as `solref` wants it, and friction.
std::string surface(double step, double friction, double restitution) {
  const double frequency = std::numbers::pi / (steps_of_rebound * step);
  std::ostringstream text;
  text.precision(17);
  text << " condim='3' friction='" << friction << " 0 0' solimp='0.9999 0.9999 0.001' solref='"
       << -frequency * frequency << ' ' << -2.0 * damping_ratio(restitution) * frequency << "' priority='1'";
  return text.str();
}

class MujocoWorld final : public RigidWorld {
public:
  MujocoWorld(double step, std::string integrator) : RigidWorld(step), integrator_(std::move(integrator)) {}
  ~MujocoWorld() final {
    mj_deleteData(data_);
    mj_deleteModel(model_);
  }

  void add_plane(const Plane& plane) final { planes_.push_back(plane); }
  void add_body(Mass mass, const Body& at, const std::vector<Disc>& discs) final {
    parts_.push_back({mass, at, discs});
  }
  void add_spring(const net::Spring& spring) final { springs_.push_back(spring); }
  void add_pin(const Pin& pin) final { pins_.push_back(pin); }

  void finish() final {
    load(text());
    data_ = mj_makeData(model_);
    if (!pins_.empty()) return;
    mjtNum* v = data_->qvel;
    for (const Part& part : parts_) {
      v[0] = part.start.vx;
      v[1] = part.start.vy;
      v += freedoms(part);
    }
  }

  [[nodiscard]] std::vector<Body> bodies() const final {
    if (!pins_.empty()) return rods();
    std::vector<Body> all;
    const mjtNum *q = data_->qpos, *v = data_->qvel;
    for (const Part& part : parts_) {
      Body body{.x = part.start.x + q[0], .y = part.start.y + q[1], .vx = v[0], .vy = v[1]};
      if (freedoms(part) == 3) body.spin = v[2];
      all.push_back(body);
      q += freedoms(part);
      v += freedoms(part);
    }
    return all;
  }

private:
  struct Part {
    Mass mass;
    Body start;
    std::vector<Disc> discs;
  };

  static int freedoms(const Part& part) { return part.mass.inertia > 0.0 ? 3 : 2; }

  [[nodiscard]] std::vector<Body> rods() const {
    std::vector<double> angles, rates;
    double angle = 0.0, rate = 0.0;
    for (int i = 0; i < model_->nq; ++i) {
      angles.push_back(angle += data_->qpos[i]);
      rates.push_back(rate += data_->qvel[i]);
    }
    return chain::bodies(angles, rates);
  }

  void make_step() final {
    mj_step(model_, data_);
    for (int i = 0; i < mjNWARNING; ++i) {
      if (data_->warning[i].number > 0)
        throw std::runtime_error(mju_warningText(i, data_->warning[i].lastinfo));
    }
  }

  static void open_body(std::ostream& text, double x, double y, double centre, Mass mass) {
    const double inertia = mass.inertia > 0.0 ? mass.inertia : mass.mass;  // of a particle nothing turns
    text << "<body pos='" << x << ' ' << y << " 0'><inertial pos='" << centre << " 0 0' mass='" << mass.mass
         << "' diaginertia='" << inertia << ' ' << inertia << ' ' << inertia << "'/>";
  }

  /// Rods hang in each other, each on a hinge at the end of the rod before.
  void write_rods(std::ostream& text) const {
    double x = 0.0;  // of the hinge in the frame of the rod before
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      open_body(text, x, 0.0, -pins_[i].after_x, parts_[i].mass);
      text << "<joint type='hinge' axis='0 0 1'/>";
      if (i + 1 < parts_.size()) x = pins_[i + 1].before_x - pins_[i].after_x;
    }
    for (std::size_t i = 0; i < parts_.size(); ++i) text << "</body>";
  }

  void write_bodies(std::ostream& text) const {
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      const Part& part = parts_[i];
      open_body(text, part.start.x, part.start.y, 0.0, part.mass);
      text << "<joint type='slide' axis='1 0 0'/><joint type='slide' axis='0 1 0'/>";
      if (freedoms(part) == 3) text << "<joint type='hinge' axis='0 0 1'/>";
      if (!springs_.empty()) text << "<site name='s" << i << "' size='0.001'/>";
      for (const Disc& disc : part.discs) {
        text << "<geom type='sphere' size='" << disc.radius << "' pos='" << disc.x << ' ' << disc.y
             << " 0' contype='0' conaffinity='1' condim='3'/>";
      }
      text << "</body>";
    }
  }

  [[nodiscard]] std::string text() const {
    std::ostringstream text;
    text.precision(17);
    text << "<mujoco>" << (springs_.empty() ? "" : "<size njmax='2000' nconmax='500'/>")
         << "<option timestep='" << step() << "' gravity='0 " << -gravity << " 0' integrator='" << integrator_
         << "'/><worldbody>";
    for (const Plane& plane : planes_) {
      text << "<geom type='plane' size='0 0 1' pos='" << plane.x << ' ' << plane.y << " 0' zaxis='"
           << plane.nx << ' ' << plane.ny << " 0' contype='1' conaffinity='0'"
           << surface(step(), plane.friction, plane.restitution) << "/>";
    }
    pins_.empty() ? write_bodies(text) : write_rods(text);
    text << "</worldbody><tendon>";
    for (const net::Spring& spring : springs_) {
      text << "<spatial stiffness='" << net::stiffness << "' damping='" << net::damping << "' springlength='"
           << spring.length << "'><site site='s" << spring.from << "'/><site site='s" << spring.to
           << "'/></spatial>";
    }
    text << "</tendon></mujoco>";
    return text.str();
  }

  void load(const std::string& text) {
    const auto files = std::make_unique<mjVFS>();
    mj_defaultVFS(files.get());
    if (mj_makeEmptyFileVFS(files.get(), "scene.xml", static_cast<int>(text.size())) != 0) {
      throw std::runtime_error("no room for the model");
    }
    std::memcpy(files->filedata[mj_findFileVFS(files.get(), "scene.xml")], text.data(), text.size());
    char why[1000] = "";
    model_ = mj_loadXML("scene.xml", files.get(), why, sizeof why);
    mj_deleteVFS(files.get());
    if (model_ == nullptr) throw std::runtime_error(why);
  }

  std::string integrator_;
  std::vector<Plane> planes_;
  std::vector<Part> parts_;
  std::vector<net::Spring> springs_;
  std::vector<Pin> pins_;
  mjModel* model_ = nullptr;
  mjData* data_ = nullptr;
};

auto world_of(const std::string& integrator) {
  return [integrator](double step) { return std::make_unique<MujocoWorld>(step, integrator); };
}

}  // namespace

Engine engine() {
  Engine mujoco{
      .name = std::string("MuJoCo ") + mj_versionString(), .cases = {}, .missing = {}, .references = {}};
  mujoco.cases.push_back(rigid_case(Scene::chain, "`Euler`", true, world_of("Euler")));
  mujoco.cases.push_back(rigid_case(Scene::chain, "`implicit`", false, world_of("implicit")));
  mujoco.cases.push_back(rigid_case(Scene::chain, "`RK4`", false, world_of("RK4")));
  const std::string contact = ", `solref` for e_n, 10 steps a rebound";
  for (const Scene scene : {Scene::net, Scene::balls}) {
    mujoco.cases.push_back(rigid_case(scene, "`Euler`" + contact, false, world_of("Euler")));
  }
  // Tried: 1.4 m and 6.8 m from the exact motion. Damping and the time of a rebound scale alike with the
  // stiffness, so that no other one takes more of the sliding.
  for (const Scene scene : {Scene::tables, Scene::bar}) {
    mujoco.missing.push_back(
        {scene,
         "friction of its soft contacts acts by their damping, of which this e_n leaves too "
         "little to stop the sliding"});
  }
  return mujoco;
}

}  // namespace compare

#pragma once

/// \file
/// The common part of all drivers: a driver makes worlds of its engine; the program around it runs them,
/// takes the time and compares with the exact motion.

#include "scenes.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace compare {

/// A scene in an engine.
class World {
public:
  World() = default;
  World(const World&) = delete;
  World& operator=(const World&) = delete;
  virtual ~World() = default;
  /// Goes on to a time [s]; this alone is timed.
  virtual void advance(double time) = 0;
  /// Bodies of the scene, in its order.
  [[nodiscard]] virtual std::vector<Body> bodies() const = 0;
};

/// A world that goes in steps of one length, as most engines do.
class SteppedWorld : public World {
public:
  explicit SteppedWorld(double step) : step_(step) {}
  void advance(double time) final {
    for (const long end = std::lround(time / step_); done_ < end; ++done_) make_step();
  }

protected:
  virtual void make_step() = 0;
  [[nodiscard]] double step() const { return step_; }

private:
  double step_;
  long done_ = 0;
};

/// One way to run a scene.
struct Case {
  Scene scene;
  std::string options;      ///< in words; the options as they come, or those that differ
  bool as_it_comes = true;  ///< the options as they come; false: tuned
  std::function<std::unique_ptr<World>(const Scale&, int start)> make;
};

/// A scene that an engine cannot run.
struct Missing {
  Scene scene;
  std::string why;
};

/// An engine.
struct Engine {
  std::string name;  ///< with its version
  std::vector<Case> cases;
  std::vector<Missing> missing;
  /// Runs to tolerances so tight that they are taken as exact, of scenes without closed form; carom alone has
  /// them.
  std::vector<Case> references;
};

/// Every driver defines it.
[[nodiscard]] Engine engine();

}  // namespace compare

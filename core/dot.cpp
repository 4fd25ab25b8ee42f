#include <carom/core/assembly.h>
#include <carom/core/dot.h>
#include <carom/core/joint_kind.h>
#include <carom/core/part_check.h>
#include <carom/core/system.h>

#include <algorithm>
#include <string_view>
#include <vector>

namespace carom {

namespace {

/// Text as a quoted string. Graphviz reads backslashes and entities in labels, so both are escaped.
std::string quoted(std::string_view text) {
  std::string result = "\"";
  for (const char letter : text) {
    switch (letter) {
      case '"':
        result += "\\\"";
        break;
      case '\\':
        result += "\\\\";
        break;
      case '&':
        result += "&amp;";
        break;
      case '\n':
        result += "\\n";
        break;
      default:
        // Other control characters may not stand in an SVG file.
        result += static_cast<unsigned char>(letter) < 0x20 ? ' ' : letter;
    }
  }
  return result + "\"";
}

std::string node(BodyId id) { return id == ground ? "ground" : "body" + std::to_string(id.serial); }
std::string node(ElementId id) { return "element" + std::to_string(id.serial); }
std::string node(JointId id) { return "joint" + std::to_string(id.serial); }
std::string node(ShapeId id) { return "shape" + std::to_string(id.serial); }
std::string node(ObstacleId id) { return "obstacle" + std::to_string(id.serial); }

/// Writes the picture of one system, statement by statement.
class Picture {
public:
  explicit Picture(const System& system) : system_(system) {}

  std::string draw() {
    text_ =
        "graph carom {\n  node [fontname=\"sans-serif\"];\n  edge [fontname=\"sans-serif\", fontsize=10];\n";
    draw_components();
    draw_elements();
    draw_joints();
    draw_obstacles();
    if (ground_used_) text_ += "  ground [label=\"ground\", shape=box, style=filled, fillcolor=lightgrey];\n";
    return text_ + "}\n";
  }

private:
  void draw_components() {
    if (system_.bodies().empty()) return;
    const Assembly assembly(system_);
    for (std::size_t i = 0; i < assembly.components().size(); ++i) {
      const Range bodies = assembly.components()[i].bodies;
      const std::string number = std::to_string(i);
      text_ +=
          "  subgraph cluster_" + number + " {\n    label=\"component " + number + "\"; color=lightgrey;\n";
      std::vector<BodyId> ids;
      for (Index body = bodies.begin; body < bodies.end; ++body) ids.push_back(assembly.layout()->id(body));
      std::sort(ids.begin(), ids.end());  // the order in which they came
      for (const BodyId id : ids) draw_body(id);
      text_ += "  }\n";
    }
  }

  void draw_body(BodyId id) {
    const auto place = system_.body_kinds().place(id.serial);
    const BodyKind& kind = system_.body_kinds().kind_of(id.serial);
    text_ += "    " + node(id) +
             " [label=" + quoted(system_.name(id) + "\n" + to_text(kind.mass(place.slot)) + " kg") +
             (kind.has_orientation() ? ", shape=box, style=rounded];\n" : ", shape=ellipse];\n");
    for (const ShapeId shape : system_.shapes()) {
      const auto shape_place = system_.shape_kinds().place(shape.serial);
      if (system_.shape_kinds().kind_of(shape.serial).body(shape_place.slot) != id) continue;
      text_ += "    " + node(shape) + " [label=" + quoted(system_.name(shape)) + ", shape=hexagon];\n";
      text_ += "    " + node(id) + " -- " + node(shape) + " [style=dotted];\n";
    }
  }

  void draw_elements() {
    std::vector<BodyId> ends;
    for (const ElementId id : system_.elements()) {
      const auto place = system_.force_kinds().place(id.serial);
      const ForceKind& kind = *system_.force_kinds().entries()[place.entry].kind;
      const std::string label = label_of(system_.name(id), kind.on_joint(place.slot));
      ends.clear();
      kind.ends(place.slot, ends);
      if (kind.is_field()) {
        text_ += "  " + node(id) + label + ", shape=note];\n";
      } else {
        draw_edge(node(id), label, ends, "", ";\n");
      }
    }
  }

  // Bold: what binds.
  void draw_joints() {
    std::vector<BodyId> ends;
    for (const JointId id : system_.joints()) {
      const auto place = system_.joint_kinds().place(id.serial);
      const JointKind& kind = *system_.joint_kinds().entries()[place.entry].kind;
      ends.clear();
      kind.ends(place.slot, ends);
      draw_edge(node(id), label_of(system_.name(id), kind.on_joint(place.slot)), ends, ", style=bold",
                " [style=bold];\n");
    }
  }

  // A part on the coordinate of a joint names the joint.
  [[nodiscard]] std::string label_of(const std::string& name, JointId on) const {
    return " [label=" + quoted(on.valid() ? name + "\non " + system_.name(on) : name);
  }

  // Two ends make an edge, any other number a node of its own.
  void draw_edge(const std::string& own, const std::string& label, const std::vector<BodyId>& ends,
                 const char* style, const char* end_of_line) {
    ground_used_ = ground_used_ || std::find(ends.begin(), ends.end(), ground) != ends.end();
    if (ends.size() == 2) {
      text_ += "  " + node(ends[0]) + " -- " + node(ends[1]) + label + style + "];\n";
      return;
    }
    text_ += "  " + own + label + (ends.size() == 1 ? ", shape=plaintext];\n" : ", shape=diamond];\n");
    for (const BodyId end : ends) text_ += "  " + own + " -- " + node(end) + end_of_line;
  }

  void draw_obstacles() {
    for (const ObstacleId obstacle : system_.obstacles()) {
      text_ += "  " + node(obstacle) + " [label=" + quoted(system_.name(obstacle)) +
               ", shape=box, style=filled, fillcolor=lightgrey];\n";
      for (const BodyId body : system_.bodies()) {
        const Index slot = system_.body_kinds().place(body.serial).slot;
        const BodyKind& kind = system_.body_kinds().kind_of(body.serial);
        if (kind.has_contact_point(slot))
          draw_contact(node(body), kind.material(slot), kind.filter(slot), obstacle);
      }
      for (const ShapeId shape : system_.shapes()) {
        const Index slot = system_.shape_kinds().place(shape.serial).slot;
        const ShapeKind& kind = system_.shape_kinds().kind_of(shape.serial);
        draw_contact(node(shape), kind.material(slot), kind.filter(slot), obstacle);
      }
    }
  }

  void draw_contact(const std::string& from, MaterialId material, const ContactFilter& filter,
                    ObstacleId obstacle) {
    const auto place = system_.ground_shape_kinds().place(obstacle.serial);
    if (!may_touch(filter, system_.ground_shape_kinds().entries()[place.entry].kind->filter(place.slot)))
      return;
    const std::optional<Surface> law = system_.law(material, obstacle);
    text_ += "  " + from + " -- " + node(obstacle) + " [style=dashed, label=";
    if (law) {
      text_ += quoted("mu " + to_text(law->friction) + ", e_n " + to_text(law->normal_restitution) +
                      ", e_t " + to_text(law->tangential_restitution)) +
               "];\n";
    } else {
      text_ += "\"no law\", color=red, fontcolor=red];\n";
    }
  }

  const System& system_;
  std::string text_;
  bool ground_used_ = false;
};

}  // namespace

std::string to_dot(const System& system) { return Picture(system).draw(); }

}  // namespace carom

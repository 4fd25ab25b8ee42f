#pragma once

/// \file
/// An outline as the narrow phase sees it: its form, and where it is.

#include <carom/contact/detection/convex_outline.h>

#include <cstddef>
#include <cstdint>

namespace carom {

struct FaceChain;
struct GroundFace;

/// Forms of outlines for which gaps are found in different ways. Those of bodies come first.
enum class OutlineForm : std::uint8_t {
  disc,     ///< one vertex: a point or a disc
  polygon,  ///< several vertices: a segment, a capsule, a polygon
  hollow,   ///< on ground: everything but the inside of a circle
  face,     ///< on ground: one face of a polyline, which its neighbours go on
  chain     ///< on ground: several faces, each of which goes on in the next one
};

/// Number of forms.
inline constexpr std::size_t outline_forms = 5;

/// An outline in the frame in which its gaps are found. A view.
struct PlacedOutline {
  OutlineForm form = OutlineForm::disc;  ///< by which the narrow phase chooses
  ConvexOutline outline;  ///< its vertices and radius: of a hollow the circle, of a face or a chain nothing
  const GroundFace* face = nullptr;  ///< of a face; of others null
  const FaceChain* chain = nullptr;  ///< of a chain; of others null

  /// A disc or a polygon.
  explicit PlacedOutline(const ConvexOutline& convex)
      : form(convex.size() > 1 ? OutlineForm::polygon : OutlineForm::disc), outline(convex) {}
  /// A face. \param of outlives this
  explicit PlacedOutline(const GroundFace& of) : form(OutlineForm::face), face(&of) {}
  /// A chain. \param of outlives this
  explicit PlacedOutline(const FaceChain& of) : form(OutlineForm::chain), chain(&of) {}
  /// Everything but the inside of a circle. \param circle its centre and radius
  [[nodiscard]] static PlacedOutline outside_of(const ConvexOutline& circle) {
    PlacedOutline out(circle);
    out.form = OutlineForm::hollow;
    return out;
  }
};

}  // namespace carom

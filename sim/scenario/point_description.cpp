#include "sim/scenario/point_description.h"

#include <algorithm>

#include "sim/sensor/fisheye.h"

namespace sim {
namespace {

// Whether what is seen at all places within the margin has Z > 0. The corners look farthest from the axis.
bool LooksAhead(const CameraParams& c, double margin_px) {
  if (c.lens != Lens::fisheye) return true;
  for (const double u : {margin_px - 0.5, c.width - margin_px - 0.5}) {
    for (const double v : {margin_px - 0.5, c.height - margin_px - 0.5}) {
      const auto direction = Fisheye{{c.k1, c.k2, c.k3, c.k4}}.Unproject({(u - c.cx) / c.fx, (v - c.cy) / c.fy});
      if (direction && !(direction->z > 0)) return false;
    }
  }
  return true;
}

}  // namespace

std::vector<settings::FieldProblem> Problems(PointDescription p, const CameraParams& camera) {
  settings::FieldCheck check;
  Visit(check, p);
  if (p.landmarks != Landmarks::prior) return check.problems;
  check.Require(2 * p.margin_px < std::min(camera.width, camera.height), "margin", p.margin_px,
                "px must leave something of the image");
  check.Require(
      LooksAhead(camera, p.margin_px), "margin", p.margin_px,
      "px must leave out what the fisheye lens sees 90 degrees and more from its axis: a landmark of a prior begins in "
      "front of the camera");
  return check.problems;
}

}  // namespace sim

// Search set of a frame: the landmarks that are predicted to be visible, at most max_searched of them. Private to
// vo/frontend.
// Source:  docs/algorithm.md, section 7.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "vo/base/params.h"
#include "vo/features/matcher.h"
#include "vo/filter/filter.h"
#include "vo/frontend/prepared_frame.h"
#include "vo/frontend/rolling_shutter.h"
#include "vo/geometry/camera.h"
#include "vo/map/landmark_record.h"

namespace vo {

// Input of the association of one frame.
struct AssociationContext {
  const Filter& filter;
  std::span<const LandmarkRecord> records;  // in the order of the filter's landmarks
  const Camera& camera;
  const PreparedFrame& frame;
  const Params& params;
  SinceUpdate since_update;
  RollingShutter shutter;
  ReferencePath reference;

  const PoseGaussian& prediction() const { return reference.prediction; }
  const Vector6& velocity() const { return filter.belief().velocity; }
};

struct Candidate {
  int landmark = 0;
  ImagePrediction prediction;  // on the plane z = 1
  Eigen::Vector2d pixel;       // the same in the image
  Eigen::Matrix2d lens;        // d pixel / d(plane z = 1)
  double inflation = 1;        // factor on a match's covariance, from the landmark's residual history
};

// Landmarks whose score, viewing angle, baseline and predicted pixel (at least `border_px` from the edge) permit a
// search.
std::vector<Candidate> FindCandidates(const AssociationContext& in, int border_px);

// Keeps max_searched candidates, of high score and spread over the image. Returns the predicted pixels of the others.
std::vector<Eigen::Vector2d> LimitToBudget(std::vector<Candidate>& candidates, const AssociationContext& in);

SearchRequest RequestFor(const AssociationContext& in, const Candidate& candidate);

}  // namespace vo

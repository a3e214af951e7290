// Visual odometry on points of known identity instead of images: the filter of Odometry without detection, matching and
// existence score.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "vo/base/params.h"
#include "vo/base/result.h"
#include "vo/filter/filter.h"
#include "vo/filter/mixture.h"
#include "vo/geometry/camera.h"

namespace vo {

struct PointObservation {
  std::int64_t id = 0;                              // of the landmark
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  // [px]
};

struct PointFrame {
  std::int64_t stamp_ns = 0;
  std::vector<PointObservation> observations;  // ids are unique
};

class PointOdometry {
 public:
  // Throws std::invalid_argument listing every bad parameter and every part of the prior that is not finite.
  PointOdometry(const Camera& camera, const Params& params, const Prior& prior, std::uint64_t seed);
  ~PointOdometry();
  PointOdometry(PointOdometry&&) noexcept;

  // A new id becomes a landmark; one unseen for params.landmark.forget_after frames is dropped. Observations at pixels
  // that are not invertible are ignored; outliers are rejected with params.filter.reject_outliers. Throws
  // std::invalid_argument, and changes nothing, when the stamp does not increase, an id is not unique or a pixel is not
  // finite; FilterFault (vo/filter/checked_filter.h) on an internal error (a bug).
  Estimate Track(const PointFrame& frame);

  // As of Odometry.
  const std::vector<StampedPose>& Reissued() const;
  // Mixture whose moments are the estimate.
  const std::vector<BeliefComponent>& Mixture() const;
  const Filter& filter() const;
  // MapPoint::id is that of the observation.
  std::vector<MapPoint> Map() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vo

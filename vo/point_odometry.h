// Purpose: the odometry without images: points of known identity in, estimate out. The filter is Odometry's; detection, matching and
//          existence score are left out, so that what is measured is the filter alone.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "vo/filter/filter.h"
#include "vo/filter/mixture.h"
#include "vo/odometry.h"

namespace vo {

struct PointObservation {
  std::int64_t id = 0;                              // the same for the same landmark in every frame
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  // [px]
};

struct PointFrame {
  std::int64_t stamp_ns = 0;
  std::vector<PointObservation> observations;  // no id twice
};

class PointOdometry {
 public:
  // Throws std::invalid_argument listing every bad parameter, and what of the prior is no number.
  PointOdometry(const Camera& camera, const Params& params, const Prior& prior, std::uint64_t seed);
  ~PointOdometry();
  PointOdometry(PointOdometry&&) noexcept;

  // A new id becomes a landmark; one unseen for params.landmark.forget_after frames is dropped. Observations where the lens has no ray are left
  // out, those that contradict the others are set aside where params.filter.reject_outliers says so. Throws std::invalid_argument, and changes nothing, when
  // the stamp does not increase, an id comes twice or a pixel is no number; FilterFault (vo/filter/watched_filter.h) would be ours.
  Estimate Track(const PointFrame& frame);

  // What the estimate is the moments of.
  const std::vector<BeliefComponent>& Mixture() const;
  const Filter& filter() const;
  // Inverse depth of the landmarks in the map; MapPoint::id is the observation's.
  std::vector<MapPoint> Map() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vo

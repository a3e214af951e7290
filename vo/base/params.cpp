#include "vo/base/params.h"

namespace vo {

std::vector<settings::FieldProblem> Problems(Params params) {
  settings::FieldCheck check;
  Visit(check, params);

  const FilterParams& filter = params.filter;
  check.Require(filter.ukf_beta >= filter.ukf_alpha * filter.ukf_alpha, "filter.ukf_beta", filter.ukf_beta,
                "must be at least filter.ukf_alpha squared, or covariances lose their sign");
  if (filter.proposal == Proposal::bootstrap && filter.weight != Weight::importance) {
    check.Refuse(
        "filter.weight",
        "filter.weight must be importance where filter.proposal is bootstrap: a proposal without the image has "
        "no evidence");
  }
  if (filter.weight == Weight::uniform)
    check.Require(filter.lag > 0, "filter.lag", filter.lag,
                  "must be above 0 for filter.weight uniform: only the images of the window weight the samples");
  if (filter.lag > 0) {
    check.Require(filter.proposal == Proposal::ekf || filter.proposal == Proposal::iterated, "filter.lag", filter.lag,
                  "needs filter.proposal ekf or iterated: bootstrap and ukf have no window of poses");
    check.Require(filter.sampled == Sampled::pose, "filter.lag", filter.lag, "needs the velocity unsampled (rb2pf)");
    check.Require(filter.weight != Weight::importance, "filter.lag", filter.lag, "needs weight: evidence or uniform");
  }

  const FeatureParams& features = params.features;
  check.Require(features.fast_threshold_start >= features.fast_threshold_min, "features.fast_threshold_start",
                features.fast_threshold_start, "must not be below features.fast_threshold_min");
  check.Require(features.search_wide_px >= features.search_normal_px, "features.search_wide", features.search_wide_px,
                "must not be below features.search_normal");
  check.Require(features.search_uncertain_px >= features.search_wide_px, "features.search_uncertain",
                features.search_uncertain_px, "must not be below features.search_wide");
  check.Require(features.search_relocalise_px >= features.search_uncertain_px, "features.search_relocalise",
                features.search_relocalise_px, "must not be below features.search_uncertain");

  const TargetParams& target = params.target;
  if (target.columns != 0 || target.rows != 0) {  // the minimum of findChessboardCornersSB
    check.Require(target.columns >= 3, "target.columns", target.columns, "must be 3 or more, or 0 with target.rows 0");
    check.Require(target.rows >= 3, "target.rows", target.rows, "must be 3 or more, or 0 with target.columns 0");
    check.Require(target.square_m > 0, "target.square", target.square_m, "must be positive");
    check.Require(params.landmark.scale_sigma == 0, "landmark.scale_sigma", params.landmark.scale_sigma,
                  "must be 0 where a target gives the scale");
  }
  return check.problems;
}

}  // namespace vo

#include "vo/map/match_batch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace vo {
namespace {

CameraView ViewFrom(const Pose& camera) {
  const Eigen::Matrix3d R_WC = camera.q_WC.toRotationMatrix();
  CameraView view;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) view.R_CW[i][k] = R_WC(k, i);
    view.p[i] = camera.p_WC[i];
  }
  return view;
}

// log det(2 pi S) over all matches in front.
double LogDet(const MatchSums& sums) {
  double mantissa = 1;
  std::int64_t exponent = 0;
  for (int i = 0; i < kLanes; ++i) {
    mantissa *= sums.det_mantissa.v[i];
    exponent += sums.det_exponent.v[i];
  }
  return std::log(mantissa) + static_cast<double>(exponent) * std::numbers::ln2 +
         sums.in_front * 2 * std::log(2 * std::numbers::pi);
}

}  // namespace

const MatchKernel& MatchKernelOf(InstructionSet set) {
#ifdef __x86_64__
  if (set == InstructionSet::avx512) return match_avx512::kKernel;
  if (set == InstructionSet::avx2) return match_avx2::kKernel;
#endif
  static_cast<void>(set);
  return match_base::kKernel;
}

void MatchBatch::SetMatches(std::span<const Match> matches) {
  landmark_.clear();
  centre_offset_W_.clear();
  for (const Match& match : matches) {
    landmark_.push_back(match.landmark);
    centre_offset_W_.push_back(match.centre_offset_W);
  }
  SetBlocks();
  for (std::size_t i = 0; i < kLanes * blocks_.size(); ++i) {
    const Match& match = i < matches.size() ? matches[i] : matches.back();
    MatchLanes& block = blocks_[i / kLanes];
    const std::size_t lane = i % kLanes;
    for (int k = 0; k < 2; ++k) block.z[k].v[lane] = match.z[k];
    block.R_given[0].v[lane] = match.R(0, 0), block.R_given[1].v[lane] = match.R(0, 1),
    block.R_given[2].v[lane] = match.R(1, 1);
  }
  for (MatchLanes& block : blocks_) std::copy_n(block.R_given, 3, block.R);
}

void MatchBatch::Inflate(std::span<const double> factors) {
  for (std::size_t i = 0; i < factors.size(); ++i) {
    MatchLanes& block = blocks_[i / kLanes];
    const std::size_t lane = i % kLanes;
    for (int k = 0; k < 3; ++k) block.R[k].v[lane] = factors[i] * block.R_given[k].v[lane];
  }
}

void MatchBatch::SetLandmarks(std::span<const int> landmarks) {
  landmark_.assign(landmarks.begin(), landmarks.end());
  centre_offset_W_.assign(landmarks.size(), Eigen::Vector3d::Zero());
  SetBlocks();
  predictions_.assign(blocks_.size(), {});
}

void MatchBatch::SetBlocks() {
  blocks_.resize((landmark_.size() + kLanes - 1) / kLanes);
  for (std::size_t i = 0; i < kLanes * blocks_.size(); ++i)
    blocks_[i / kLanes].min_depth.v[i % kLanes] =
        i < landmark_.size() ? kMinDepth : std::numeric_limits<double>::infinity();
}

void MatchBatch::Load(const LocalMap& map) {
  for (std::size_t i = 0; i < kLanes * blocks_.size(); ++i) {
    const std::size_t from = std::min(i, landmark_.size() - 1);
    const int n = landmark_[from];
    const Landmark& landmark = map.landmarks[n];
    const Pose& anchor = map.anchors[map.anchor_of[n]];
    MatchLanes& block = blocks_[i / kLanes];
    const std::size_t lane = i % kLanes;
    const Eigen::Matrix3d& P = landmark.covariance;
    for (int k = 0; k < 3; ++k) block.mean[k].v[lane] = landmark.mean[k];
    block.covariance[0].v[lane] = P(0, 0), block.covariance[1].v[lane] = P(0, 1), block.covariance[2].v[lane] = P(0, 2);
    block.covariance[3].v[lane] = P(1, 1), block.covariance[4].v[lane] = P(1, 2), block.covariance[5].v[lane] = P(2, 2);
    for (int k = 0; k < 3; ++k) block.anchor_p[k].v[lane] = anchor.p_WC[k] - centre_offset_W_[from][k];
    for (int k = 0; k < 4; ++k) block.anchor_q[k].v[lane] = anchor.q_WC.coeffs()[k];
  }
  kernel_->prepare(blocks_.data(), static_cast<int>(blocks_.size()));
  following_ = false;
}

MatchBatch::Information MatchBatch::Linearise(const Pose& camera, bool marginal) {
  PoseSums sums;
  kernel_->linearise[marginal](ViewFrom(camera), step(), blocks_.data(), static_cast<int>(blocks_.size()), sums);
  linearised_at_ = camera;
  following_ = false;
  Information information;
  for (int i = 0, at = 0; i < 6; ++i) {
    for (int k = i; k < 6; ++k) information.A(i, k) = information.A(k, i) = sums.A[at++];
    information.b[i] = sums.b[i];
  }
  information.cost = sums.matches.cost;
  information.log_det = LogDet(sums.matches);
  information.behind = static_cast<int>(landmark_.size()) - static_cast<int>(sums.matches.in_front);
  return information;
}

void MatchBatch::SquaredDistances(const Pose& camera, std::vector<double>& distances) {
  distances_.resize(blocks_.size());
  kernel_->squared_distances(ViewFrom(camera), blocks_.data(), static_cast<int>(blocks_.size()), distances_.data());
  distances.resize(landmark_.size());
  for (std::size_t i = 0; i < distances.size(); ++i) distances[i] = distances_[i / kLanes].v[i % kLanes];
}

void MatchBatch::Follow(const Vector6& d) {
  step_ = d;
  following_ = true;
}

double MatchBatch::UpdateLandmarks(const Pose& camera, int max_iterations) {
  MatchSums sums;
  kernel_->update_landmarks(ViewFrom(camera), step(), max_iterations, blocks_.data(), static_cast<int>(blocks_.size()),
                            sums);
  following_ = false;
  return -0.5 * (sums.cost + LogDet(sums));
}

void MatchBatch::Store(std::span<Landmark> landmarks) const {
  for (std::size_t i = 0; i < landmark_.size(); ++i) {
    const MatchLanes& block = blocks_[i / kLanes];
    const std::size_t lane = i % kLanes;
    Landmark& landmark = landmarks[landmark_[i]];
    for (int k = 0; k < 3; ++k) landmark.mean[k] = block.mean[k].v[lane];
    for (int r = 0, at = 0; r < 3; ++r)
      for (int c = r; c < 3; ++c)
        landmark.covariance(r, c) = landmark.covariance(c, r) = block.covariance[at++].v[lane];
  }
}

void MatchBatch::AddPredictions(const Pose& camera, const Matrix6& covariance, double weight) {
  kernel_->add_predictions(ViewFrom(camera), covariance.data(), weight, blocks_.data(),
                           static_cast<int>(blocks_.size()), predictions_.data());
}

ImageMoments MatchBatch::Moments(std::size_t place) const {
  const PredictionLanes& sums = predictions_[place / kLanes];
  const auto value = [&](const Lanes& lanes) { return lanes.v[place % kLanes]; };
  ImageMoments moments{value(sums.weight), {value(sums.z[0]), value(sums.z[1])}, {}};
  moments.second << value(sums.second[0]), value(sums.second[1]), value(sums.second[1]), value(sums.second[2]);
  return moments;
}

}  // namespace vo

#include "vo/odometry.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <Eigen/LU>
#include <opencv2/imgproc.hpp>

#include "vo/features/corner_detector.h"
#include "vo/features/matcher.h"
#include "vo/filter/consensus.h"
#include "vo/filter/particle_filter.h"
#include "vo/map/existence.h"

namespace vo {
namespace {

// What all particles share about a landmark; its estimate is each particle's own.
struct Track {
  int id = 0;
  Appearance appearance;
  double score = 0;
  int age = 0;                // frames since it was first seen
  int frames_unsearched = 0;  // in a row
  bool permanent = false;
};

// A landmark to be looked for in the present image.
struct Candidate {
  int landmark = 0;
  ImagePrediction prediction;     // on the plane z = 1
  Eigen::Vector2d pixel;          // the same in the image
  Eigen::Matrix2d lens;           // d pixel / d(plane z = 1)
};

class Stopwatch {
 public:
  // Milliseconds since the last call, or since the start.
  double Lap() {
    const auto now = std::chrono::steady_clock::now();
    const double ms = std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
    return ms;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

Params Checked(const Params& params) {
  const std::vector<std::string> problems = Problems(params);
  if (problems.empty()) return params;
  std::string text;
  for (const std::string& problem : problems) text += (text.empty() ? "" : "\n") + problem;
  throw std::invalid_argument(text);
}

FilterPrior ToFilterPrior(const Prior& prior) {
  FilterPrior out;
  out.pose = {prior.pose, prior.pose_covariance};
  out.velocity << prior.v_WC, prior.w_WC_C;
  out.velocity_covariance = prior.velocity_covariance;
  return out;
}

cv::Mat Grey(const cv::Mat& image) {
  if (image.channels() == 1) return image;
  cv::Mat grey;
  cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  return grey;
}

}  // namespace

struct Odometry::Impl {
  Impl(const Camera& camera_, const Params& params_, const Prior& prior, std::uint64_t seed)
      : camera(camera_),
        params(Checked(params_)),
        filter(params.motion, params.filter, params.landmark, ToFilterPrior(prior), seed),
        brisk(params.features.brisk_size_px),
        border_px(std::max(brisk.border_px(), Patch::kRadius + 1)) {}

  Estimate Track(const Frame& frame);
  std::vector<Candidate> Candidates() const;
  bool WorthSearching(const struct Track& track, int landmark, const ImagePrediction& prediction) const;
  std::vector<std::optional<Eigen::Vector2d>> Find(const std::vector<Candidate>& candidates, const cv::Mat& grey);
  std::vector<Match> Matches(const std::vector<Candidate>& candidates,
                             const std::vector<std::optional<Eigen::Vector2d>>& found, FrameDiagnostics& diagnostics);
  void UpdateScores(const std::vector<Candidate>& candidates, const std::vector<Match>& matches);
  void Forget();
  void AddFeatures(const cv::Mat& grey);
  Eigen::Matrix2d PixelNoise(const Eigen::Matrix2d& lens) const;
  Estimate Answer(std::int64_t stamp_ns, FrameDiagnostics diagnostics) const;

  Camera camera;
  Params params;
  ParticleFilter filter;
  BriskField brisk;
  int border_px;
  std::vector<struct Track> tracks;  // in the order of the filter's landmarks
  std::vector<FeatureView> views;
  std::optional<std::int64_t> last_stamp_ns;
  int next_id = 0;
};

Estimate Odometry::Impl::Track(const Frame& frame) {
  if (frame.image.cols != camera.width || frame.image.rows != camera.height)
    throw std::invalid_argument("image is " + std::to_string(frame.image.cols) + " x " + std::to_string(frame.image.rows) +
                                ", the camera " + std::to_string(camera.width) + " x " + std::to_string(camera.height));
  if (last_stamp_ns && frame.stamp_ns <= *last_stamp_ns)
    throw std::invalid_argument("time stamp " + std::to_string(frame.stamp_ns) + " ns does not increase over " +
                                std::to_string(*last_stamp_ns) + " ns");
  FrameDiagnostics diagnostics;
  Stopwatch watch;
  const cv::Mat grey = Grey(frame.image);
  views.clear();

  if (last_stamp_ns) {
    filter.Predict(static_cast<double>(frame.stamp_ns - *last_stamp_ns) * 1e-9);
    brisk.SetImage(grey);
    const std::vector<Candidate> candidates = Candidates();
    const auto found = Find(candidates, grey);
    diagnostics.ms_matching = watch.Lap();
    const std::vector<Match> matches = Matches(candidates, found, diagnostics);
    filter.Update(matches);
    UpdateScores(candidates, matches);
    diagnostics.ms_filter = watch.Lap();
  } else {
    brisk.SetImage(grey);
  }
  last_stamp_ns = frame.stamp_ns;

  Forget();
  AddFeatures(grey);
  diagnostics.ms_features = watch.Lap();
  return Answer(frame.stamp_ns, diagnostics);
}

// Section 7: assessed in this order; then no more than max_searched, the surest first.
std::vector<Candidate> Odometry::Impl::Candidates() const {
  std::vector<Candidate> candidates;
  for (int n = 0; n < filter.landmark_count(); ++n) {
    const ImagePrediction prediction = filter.PredictImage(n);
    if (!prediction.in_front || !WorthSearching(tracks[n], n, prediction)) continue;
    const Eigen::Vector2d pixel = camera.Project({prediction.z.x(), prediction.z.y(), 1.0});
    if (!camera.Sees(pixel, border_px)) continue;
    candidates.push_back({n, prediction, pixel, camera.LensJacobian(prediction.z)});
  }
  if (static_cast<int>(candidates.size()) > params.features.max_searched) {
    std::stable_sort(candidates.begin(), candidates.end(),
                     [&](const Candidate& a, const Candidate& b) { return tracks[a.landmark].score > tracks[b.landmark].score; });
    candidates.resize(params.features.max_searched);
  }
  return candidates;
}

bool Odometry::Impl::WorthSearching(const struct Track& track, int landmark, const ImagePrediction& prediction) const {
  if (track.score < params.score.delete_below) return false;
  const Particle& particle = filter.Heaviest();
  const Pose& now = particle.prediction.mean;
  const Pose first = filter.AnchorOf(landmark);
  const Eigen::Vector3d& estimate = particle.landmarks[landmark].mean;
  const Eigen::Vector3d first_ray = first.q_WC * Eigen::Vector3d(estimate.x(), estimate.y(), 1.0).normalized();
  const Eigen::Vector3d present_ray = now.q_WC * Eigen::Vector3d(prediction.z.x(), prediction.z.y(), 1.0).normalized();
  if (first_ray.dot(present_ray) < std::cos(params.features.max_view_angle_deg * std::numbers::pi / 180)) return false;
  const double rho = estimate.z();
  return rho <= 0 || (now.p_WC - first.p_WC).norm() * rho < params.features.max_baseline_ratio;
}

std::vector<std::optional<Eigen::Vector2d>> Odometry::Impl::Find(const std::vector<Candidate>& candidates, const cv::Mat& grey) {
  const double variance = params.features.sigma_px * params.features.sigma_px;
  const Particle& particle = filter.Heaviest();
  std::vector<SearchRequest> requests;
  for (const Candidate& c : candidates) {
    const struct Track& track = tracks[c.landmark];
    const Eigen::Vector3d& estimate = particle.landmarks[c.landmark].mean;
    const Projection view = Project({particle.prediction.mean, filter.AnchorOf(c.landmark)}, estimate);
    SearchRequest request{&track.appearance, c.pixel,
                          c.lens * c.prediction.covariance * c.lens.transpose() + variance * Eigen::Matrix2d::Identity(),
                          Eigen::Matrix2d::Identity()};
    if (view.in_front)
      request.warp = c.lens * view.J_landmark.leftCols<2>() * camera.LensJacobian(estimate.head<2>()).inverse();
    requests.push_back(request);
  }
  const auto found = FindFeatures(requests, grey, brisk, params.features);
  for (std::size_t i = 0; i < candidates.size(); ++i)
    views.push_back({tracks[candidates[i].landmark].id, candidates[i].pixel, found[i].value_or(candidates[i].pixel),
                     requests[i].S, found[i] ? FeatureView::Status::matched : FeatureView::Status::missed});
  return found;
}

// Found features as measurements; outliers are taken out once for all particles, so that all are weighted on the same data.
std::vector<Match> Odometry::Impl::Matches(const std::vector<Candidate>& candidates,
                                           const std::vector<std::optional<Eigen::Vector2d>>& found,
                                           FrameDiagnostics& diagnostics) {
  std::vector<Match> matches;
  std::vector<std::size_t> candidate_of;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (!found[i]) continue;
    matches.push_back({candidates[i].landmark, camera.Undistort(*found[i]), PixelNoise(candidates[i].lens)});
    candidate_of.push_back(i);
  }
  const Particle& particle = filter.Heaviest();
  const std::vector<bool> inlier =
      FindInliers(particle.prediction, filter.MapOf(particle), matches, params.score.gate, params.filter);
  std::vector<Match> inliers;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const Candidate& c = candidates[candidate_of[i]];
    if (!inlier[i]) {
      views[candidate_of[i]].status = FeatureView::Status::rejected;
      continue;
    }
    const Eigen::Vector2d nu = matches[i].z - c.prediction.z;
    diagnostics.nis += nu.dot(Eigen::Matrix2d(c.prediction.covariance + matches[i].R).inverse() * nu);
    diagnostics.nis_dof += 2;
    inliers.push_back(matches[i]);
  }
  diagnostics.searched = static_cast<int>(candidates.size());
  diagnostics.matched = static_cast<int>(inliers.size());
  return inliers;
}

void Odometry::Impl::UpdateScores(const std::vector<Candidate>& candidates, const std::vector<Match>& matches) {
  for (struct Track& track : tracks) {
    track.score = PredictScore(track.score, params.score);
    ++track.age;
    ++track.frames_unsearched;
  }
  if (static_cast<double>(matches.size()) < params.score.blind_share * static_cast<double>(candidates.size())) return;
  std::size_t m = 0;
  for (const Candidate& c : candidates) {
    struct Track& track = tracks[c.landmark];
    std::optional<double> distance_sq;
    if (m < matches.size() && matches[m].landmark == c.landmark) {
      const Eigen::Vector2d nu = matches[m].z - c.prediction.z;
      distance_sq = nu.dot(Eigen::Matrix2d(c.prediction.covariance + matches[m].R).inverse() * nu);
      ++m;
    }
    track.score = UpdateScore(track.score, distance_sq, params.score);
    track.frames_unsearched = 0;
  }
}

void Odometry::Impl::Forget() {
  std::vector<bool> keep(tracks.size());
  int kept = 0;
  for (int n = static_cast<int>(tracks.size()) - 1; n >= 0; --n) {  // the newest first: they win when the map is full
    struct Track& track = tracks[n];
    const auto belief = filter.BeliefOf(n);
    track.permanent = belief.inverse_depth_sigma < params.landmark.permanent_ratio * belief.inverse_depth;
    const bool exists = track.score >= params.score.delete_below || track.age < params.score.grace_frames;
    keep[n] = (track.permanent || (exists && track.frames_unsearched < params.landmark.forget_after)) &&
              kept < params.landmark.max_landmarks;
    kept += keep[n];
  }
  filter.KeepLandmarks(keep);
  std::size_t to = 0;
  for (std::size_t from = 0; from < tracks.size(); ++from)
    if (keep[from]) std::swap(tracks[to++], tracks[from]);
  tracks.resize(to);
}

void Odometry::Impl::AddFeatures(const cv::Mat& grey) {
  std::vector<Eigen::Vector2d> occupied;
  for (const FeatureView& view : views)
    if (view.status == FeatureView::Status::matched) occupied.push_back(view.pixel);
  const std::vector<Eigen::Vector2i> corners = DetectCorners(grey, occupied, border_px, params.features);
  brisk.Compute(corners);
  std::vector<Eigen::Vector2d> rays;
  std::vector<Eigen::Matrix2d> noises;
  for (const Eigen::Vector2i& corner : corners) {
    const Descriptor* descriptor = brisk.At(corner);
    if (!descriptor) continue;
    const Eigen::Vector2d pixel = corner.cast<double>();
    struct Track track;
    track.appearance = {*descriptor, CutPatch(grey, corner)};
    track.id = next_id++;
    track.score = params.score.initial;
    tracks.push_back(track);
    rays.push_back(camera.Undistort(pixel));
    noises.push_back(PixelNoise(camera.LensJacobian(rays.back())));
    views.push_back({track.id, pixel, pixel, Eigen::Matrix2d::Zero(), FeatureView::Status::fresh});
  }
  filter.AddLandmarks(rays, noises);
}

// sigma_px in the image, seen on the plane z = 1.
Eigen::Matrix2d Odometry::Impl::PixelNoise(const Eigen::Matrix2d& lens) const {
  const Eigen::Matrix2d inverse = lens.inverse() * params.features.sigma_px;
  return inverse * inverse.transpose();
}

Estimate Odometry::Impl::Answer(std::int64_t stamp_ns, FrameDiagnostics diagnostics) const {
  diagnostics.landmarks = static_cast<int>(tracks.size());
  diagnostics.permanent =
      static_cast<int>(std::count_if(tracks.begin(), tracks.end(), [](const struct Track& t) { return t.permanent; }));
  diagnostics.effective_particles = filter.effective_particles();
  const Belief& belief = filter.belief();
  return {stamp_ns, belief.pose, belief.velocity.head<3>(), belief.velocity.tail<3>(), belief.covariance, diagnostics};
}

Odometry::Odometry(const Camera& camera, const Params& params, const Prior& prior, std::uint64_t seed)
    : impl_(std::make_unique<Impl>(camera, params, prior, seed)) {}
Odometry::~Odometry() = default;
Odometry::Odometry(Odometry&&) noexcept = default;

Estimate Odometry::Track(const Frame& frame) { return impl_->Track(frame); }

std::vector<MapPoint> Odometry::Map() const {
  std::vector<MapPoint> points;
  for (int n = 0; n < impl_->filter.landmark_count(); ++n) {
    const auto belief = impl_->filter.BeliefOf(n);
    points.push_back({impl_->tracks[n].id, belief.X_W, belief.inverse_depth, belief.inverse_depth_sigma, impl_->tracks[n].permanent});
  }
  return points;
}

const std::vector<FeatureView>& Odometry::Features() const { return impl_->views; }

}  // namespace vo

// Bit trace of the filter family: every bit of its answers, for 33 settings of 60 frames each, as text or as one digest
// for each setting. The text shows the first number that differs.
//
//   bit_trace             compares with bit_trace_digests.txt; without lines for this machine's key it compares one
//                         thread with three, prints the total and exits with 77
//   bit_trace --text      the whole trace; doubles as hexadecimal floating point (%a)
//   bit_trace --digests   lines for bit_trace_digests.txt
//
// Key: C library's mathematical functions (a digest of their values), compiler and Eigen. All kernel instruction sets
// give the same bits.
// Settings whose names begin with "paper_" are those of Zhou & Maskell: their digests must not change.
#include <Eigen/Core>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <limits>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "source_dir.h"
#include "tests/unit/vo/at_once.h"
#include "vo/base/instruction_set.h"
#include "vo/filter/consensus.h"
#include "vo/filter/ekf_slam.h"
#include "vo/filter/particle_filter.h"
#include "vo/geometry/so3.h"
#include "vo/scale_ambiguity.h"

namespace {

constexpr int kFrames = 60;
constexpr double kDt = 1.0 / 30, kSigma = 1.0 / 525;
constexpr double kHalfWidth = 0.6, kHalfHeight = 0.45;  // of the field of view, plane z = 1
constexpr double kReadout = 0.02;                       // [s] of a rolling shutter, over the field of view

// 64-bit FNV-1a over values; every NaN counts as the same.
class Trace {
 public:
  explicit Trace(bool text) : text_(text) {}
  std::uint64_t digest() const { return digest_; }
  const std::string& text() const { return lines_; }

  void Begin(int frame, const char* what) {
    if (text_) Print("\n%d %s", frame, what);
  }
  void Add(double value) {
    Mix(std::isnan(value) ? 0x7ff8000000000000u : std::bit_cast<std::uint64_t>(value));
    if (text_) Print(std::isnan(value) ? " nan" : " %a", value);
  }
  void Add(const vo::Pose& pose) {
    Add(pose.p_WC);
    Add(pose.q_WC.coeffs());
  }
  template <class Derived>
  void Add(const Eigen::DenseBase<Derived>& matrix) {
    for (Eigen::Index i = 0; i < matrix.rows(); ++i)
      for (Eigen::Index k = 0; k < matrix.cols(); ++k) Add(static_cast<double>(matrix(i, k)));
  }

 private:
  void Mix(std::uint64_t bits) {
    for (int i = 0; i < 8; ++i, bits >>= 8) digest_ = (digest_ ^ (bits & 0xff)) * 0x100000001b3u;
  }
  [[gnu::format(printf, 2, 3)]] void Print(const char* format, ...) {
    char buffer[64];
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(buffer, sizeof buffer, format, arguments);
    va_end(arguments);
    lines_ += buffer;
  }

  bool text_;
  std::uint64_t digest_ = 0xcbf29ce484222325u;
  std::string lines_;
};

// Events of a run besides the measurements.
struct Events {
  bool rolling = false;
  bool known_depths = false;
  bool unknown_start = false;
  int blackout_from = kFrames, blackout_to = kFrames;  // frames without matches
  int poisoned = 0;                                    // frame before which a particle's weight becomes NaN
  bool bad_matches = false;
};

struct Setting {
  std::string name;
  vo::FilterParams filter;
  vo::Bearing bearing = vo::Bearing::estimated;
  Events events = {};
};

// Uniform numbers in [0, 1): splitmix64.
class Uniforms {
 public:
  double operator()() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }
  double Noise() { return kSigma * 2 * ((*this)() + (*this)() + (*this)() - 1.5); }  // unit variance times sigma

 private:
  std::uint64_t state_ = 42;
};

vo::Pose TruePose(double t) {
  return {{0.25 * t, 0.08 * std::sin(2.2 * t), 0.06 * t + 0.02 * std::sin(3 * t)},
          vo::Exp({0.10 * std::sin(1.7 * t), -0.16 * t, 0.08 * std::sin(2.5 * t)})};
}

class Player {
 public:
  Player(const Setting& setting, Trace& trace) : setting_(setting), trace_(trace), scale_(0.5, {0, 0, 0}) {
    vo::LandmarkParams landmark{.scale_sigma = 0};
    landmark.bearing = setting.bearing;
    vo::MotionParams motion;
    motion.adaptive = !setting.name.starts_with("paper_");  // as rb2pf_paper and rbpf_paper have it
    vo::FilterPrior prior;
    prior.velocity << 0.2, 0.1, 0.05, 0.1, -0.1, 0.1;
    prior.velocity_covariance.diagonal() << 0.04, 0.05, 0.06, 0.03, 0.04, 0.05;
    if (setting.events.unknown_start) prior.pose.covariance.diagonal() << 0.3, 0.2, 0.1, 0.04, 0.03, 0.05;
    if (setting.filter.sampled == vo::Sampled::nothing) {
      filter_ = std::make_unique<vo::EkfSlam>(motion, setting.filter, landmark, prior);
    } else {
      auto filter = std::make_unique<vo::ParticleFilter>(motion, setting.filter, landmark, prior, 7);
      particles_ = filter.get();
      filter_ = std::move(filter);
    }
  }

  void Play() {
    AddLandmarks(0, 20);
    for (int frame = 1; frame <= kFrames; ++frame) {
      if (frame == setting_.events.poisoned) Poison();
      filter_->Predict(frame % 9 == 0 ? 1.5 * kDt : kDt);
      time_ += frame % 9 == 0 ? 1.5 * kDt : kDt;
      TracePrediction(frame);
      filter_->Update(See(frame));
      scale_.AbsorbChange(filter_->answer().scale_change);
      TraceAnswer(frame, "answer");
      TraceMap(frame);
      if (frame % 20 == 13) Drop();
      const bool dark = frame >= setting_.events.blackout_from && frame < setting_.events.blackout_to;
      if (frame % 8 == 3) AddLandmarks(frame, dark ? 2 : 5);
      TraceAnswer(frame, "end");
    }
  }

 private:
  // Noisy image of a point from the true pose; with a rolling shutter, from the pose at the time of its row.
  vo::RowView Seen(const Eigen::Vector3d& point) {
    vo::RowView row;
    for (int i = 0; i < (setting_.events.rolling ? 5 : 1); ++i) {
      const vo::Pose camera = TruePose(time_ + row.time);
      row.z = (camera.q_WC.conjugate() * (point - camera.p_WC)).hnormalized();
      if (setting_.events.rolling) row.time = kReadout * row.z.y() / (2 * kHalfHeight);
    }
    row.z += Eigen::Vector2d(random_.Noise(), random_.Noise());
    return row;
  }

  void AddLandmarks(int frame, int count) {
    const vo::Pose camera = TruePose(time_);
    std::vector<vo::FirstView> views;
    for (int n = 0; n < count; ++n) {
      const Eigen::Vector3d ray(kHalfWidth * (2 * random_() - 1), kHalfHeight * (2 * random_() - 1), 1);
      const double depth = 2 + 4 * random_();
      points_.push_back(camera.p_WC + camera.q_WC * (depth * ray));
      views.push_back(vo::FirstSeen(Seen(points_.back()), filter_->belief().pose, filter_->belief().velocity));
      views.back().R = kSigma * kSigma * Eigen::Matrix2d::Identity();
      if (setting_.events.known_depths && frame == 0 && n % 2 == 0)
        views.back().depth = vo::KnownDepth{1 / depth, 0.002};
    }
    filter_->AddLandmarks(views);
  }

  void Drop() {
    std::vector<bool> keep;
    std::vector<Eigen::Vector3d> kept;
    for (std::size_t n = 0; n < points_.size(); ++n) {
      keep.push_back(n % 3 != 1);
      if (keep.back()) kept.push_back(points_[n]);
    }
    points_ = kept;
    filter_->KeepLandmarks(keep);
  }

  std::vector<vo::Match> See(int frame) {
    std::vector<vo::Match> matches;
    if (frame >= setting_.events.blackout_from && frame < setting_.events.blackout_to) return matches;
    const vo::Pose camera = TruePose(time_);
    for (std::size_t n = 0; n < points_.size(); ++n) {
      const Eigen::Vector3d X = camera.q_WC.conjugate() * (points_[n] - camera.p_WC);
      const double missed = random_();
      if (!(X.z() > 0.2) || std::abs(X.x()) > 0.8 * X.z() || std::abs(X.y()) > 0.7 * X.z() || missed < 0.15) continue;
      const vo::RowView row = Seen(points_[n]);
      const auto [z, centre_offset_W] = row.RotationCompensated(filter_->belief().velocity);
      Eigen::Matrix2d R = kSigma * kSigma * Eigen::Matrix2d::Identity();
      R(0, 1) = R(1, 0) = 0.1 * kSigma * kSigma;
      matches.push_back({static_cast<int>(n), z, R, centre_offset_W, row});
      if (setting_.events.bad_matches && n % 7 == 3) matches.back().z.x() += 30 * kSigma;
    }
    if (!setting_.events.bad_matches) return matches;
    const std::vector<bool> inlier =
        vo::FindInliers(filter_->Reference().prediction, filter_->Reference().map, matches,
                        vo::OutlierGate(filter_->answer(), vo::ScoreParams{}), setting_.filter);
    trace_.Begin(frame, "inliers");
    std::vector<vo::Match> chosen;
    for (std::size_t i = 0; i < matches.size(); ++i) {
      trace_.Add(inlier[i] ? 1 : 0);
      if (inlier[i]) chosen.push_back(matches[i]);
    }
    return chosen;
  }

  // Sets one particle's weight to NaN. No image leads to this state: written by const_cast.
  void Poison() {
    const_cast<vo::Particle&>(particles_->particles()[3]).log_weight = std::numeric_limits<double>::quiet_NaN();
  }

  void TracePrediction(int frame) {
    trace_.Begin(frame, "prediction");
    trace_.Add(filter_->Reference().prediction.mean);
    trace_.Add(filter_->Reference().prediction.covariance);
    trace_.Begin(frame, "map");
    const vo::LocalMap map = filter_->Reference().map;
    std::vector<int> all;
    for (int n = 0; n < filter_->landmark_count(); ++n) {
      all.push_back(n);
      trace_.Add(map.landmarks[static_cast<std::size_t>(n)].mean);
      trace_.Add(map.landmarks[static_cast<std::size_t>(n)].covariance);
      trace_.Add(map.anchors[static_cast<std::size_t>(map.anchor_of[static_cast<std::size_t>(n)])]);
      trace_.Add(filter_->Reference().ModeOf(n));
      trace_.Add(filter_->Reference().AnchorOf(n));
    }
    trace_.Begin(frame, "images");
    for (const vo::ImagePrediction& image : filter_->PredictImages(all)) {
      trace_.Add(image.in_front ? 1 : 0);
      trace_.Add(image.z);
      trace_.Add(image.covariance);
    }
  }

  void TraceAnswer(int frame, const char* what) {
    trace_.Begin(frame, what);
    const vo::Belief& belief = filter_->belief();
    trace_.Add(belief.pose);
    trace_.Add(belief.velocity);
    trace_.Add(belief.covariance);
    trace_.Begin(frame, "mixture");
    for (const vo::BeliefComponent& component : filter_->mixture()) {
      trace_.Add(component.weight);
      trace_.Add(component.pose);
      trace_.Add(component.velocity);
      trace_.Add(component.covariance);
    }
    trace_.Begin(frame, "events");
    const vo::NumericalEvents& events = filter_->answer().events;
    for (const int count :
         {events.not_converged, events.behind_camera, events.not_positive_definite, events.non_finite_weight})
      trace_.Add(count);
    trace_.Add(filter_->answer().effective_particles);
    trace_.Add(filter_->answer().initialising ? 1 : 0);
    trace_.Add(filter_->answer().scale_change);
    trace_.Add(scale_.ToAnswer(belief.pose));
    trace_.Add(scale_.Covariance(belief.pose, belief.velocity, belief.covariance));
  }

  void TraceMap(int frame) {
    trace_.Begin(frame, "beliefs");
    for (const vo::Filter::LandmarkBelief& belief : filter_->LandmarkBeliefs()) {
      trace_.Add(belief.X_W);
      trace_.Add(belief.inverse_depth);
      trace_.Add(belief.inverse_depth_sigma);
    }
    trace_.Begin(frame, "sigmas");
    const std::vector<vo::Filter::LandmarkSpread> spreads = filter_->LandmarkSpreads();
    for (const auto& spread : spreads) trace_.Add(spread.inverse_depth_sigma);
    trace_.Begin(frame, "points");
    for (const auto& [sigma, place] : spreads) {
      trace_.Add(place ? 1 : 0);
      if (!place) continue;
      trace_.Add(place->mean);
      trace_.Add(place->covariance);
    }
  }

  const Setting& setting_;
  Trace& trace_;
  vo::ScaleAmbiguity scale_;
  std::unique_ptr<vo::Filter> filter_;
  vo::ParticleFilter* particles_ = nullptr;
  std::vector<Eigen::Vector3d> points_;  // in the order of the filter's landmarks [m in W]
  double time_ = 0;
  Uniforms random_;
};

std::vector<Setting> Settings() {
  using enum vo::Proposal;
  using enum vo::Weight;
  using vo::Bearing;
  using vo::Sampled;
  const auto params = [](vo::Proposal proposal, vo::Weight weight, int lag, int start_window) {
    vo::FilterParams p = vo_test::SampledAtOnce();
    p.proposal = proposal;
    p.weight = weight;
    p.lag = lag;
    p.start_window = start_window;
    return p;
  };
  const auto with = [](vo::FilterParams p, Sampled sampled) {
    p.sampled = sampled;
    return p;
  };
  const auto marginal = [](vo::FilterParams p) {
    p.marginal_mode = true;
    return p;
  };
  const auto sized = [](vo::FilterParams p, int particles) {
    p.particles = particles;
    return p;
  };
  const Events dark{.blackout_from = 24, .blackout_to = 32}, early{.blackout_from = 3, .blackout_to = 5};
  vo::FilterParams joint = with(params(iterated, evidence, 0, 0), Sampled::nothing);
  joint.joint_iterations = 10;
  return {
      {"paper_rb2pf_ukf", params(ukf, importance, 0, 0), Bearing::fixed},
      {"paper_rb2pf_ekf", params(ekf, importance, 0, 0), Bearing::fixed},
      {"paper_rbpf_ukf", with(params(ukf, importance, 0, 0), Sampled::pose_and_velocity), Bearing::fixed},
      {"paper_rbpf_ekf", with(params(ekf, importance, 0, 0), Sampled::pose_and_velocity), Bearing::fixed},
      {"fastslam1", with(params(bootstrap, importance, 0, 0), Sampled::pose_and_velocity), Bearing::fixed},
      {"bootstrap", sized(params(bootstrap, importance, 0, 0), 16), Bearing::estimated, dark},
      {"ukf", params(ukf, importance, 0, 0), Bearing::estimated, dark},
      {"ukf_evidence_rolling", params(ukf, evidence, 0, 0), Bearing::fixed, {.rolling = true}},
      {"ekf", params(ekf, evidence, 0, 0), Bearing::estimated, dark},
      {"iterated", params(iterated, evidence, 0, 0), Bearing::estimated, {.bad_matches = true}},
      {"iterated_importance", params(iterated, importance, 0, 0), Bearing::estimated, dark},
      {"iterated_marginal", marginal(params(iterated, evidence, 0, 0)), Bearing::estimated, {.known_depths = true}},
      {"iterated_rolling", params(iterated, evidence, 0, 0), Bearing::estimated, {.rolling = true}},
      {"iterated_unknown_start", params(iterated, evidence, 0, 0), Bearing::fixed, {.unknown_start = true}},
      {"iterated_poisoned", params(iterated, evidence, 0, 0), Bearing::estimated, {.poisoned = 20}},
      {"rbpf", with(params(iterated, evidence, 0, 0), Sampled::pose_and_velocity), Bearing::estimated, dark},
      {"ekfslam", with(params(iterated, evidence, 0, 0), Sampled::nothing), Bearing::estimated, dark},
      {"ekfslam_joint", joint, Bearing::estimated, {.bad_matches = true}},
      {"ekfslam_fixed_rolling", joint, Bearing::fixed, {.rolling = true}},
      {"lag3", params(iterated, evidence, 3, 0), Bearing::estimated, dark},
      {"lag3_early_blackout", params(iterated, evidence, 3, 0), Bearing::fixed, early},
      {"lag3_equal", params(iterated, uniform, 3, 0), Bearing::estimated, {.bad_matches = true}},
      {"lag3_ekf", params(ekf, evidence, 3, 3), Bearing::fixed, {.unknown_start = true}},
      {"lag3_poisoned", params(iterated, evidence, 3, 0), Bearing::estimated, {.poisoned = 20}},
      {"lag5_marginal", marginal(params(iterated, evidence, 5, 5)), Bearing::estimated, {.known_depths = true}},
      {"lag5_equal", sized(params(iterated, uniform, 5, 0), 16), Bearing::estimated, {.rolling = true}},
      {"start5", params(iterated, evidence, 0, 5), Bearing::estimated, early},
      {"start5_lag3",
       params(iterated, uniform, 3, 5),
       Bearing::estimated,
       {.rolling = true, .blackout_from = 4, .blackout_to = 7}},
      {"start5_ekf_rolling", params(ekf, evidence, 0, 5), Bearing::estimated, {.rolling = true}},
      {"start5_poisoned", params(iterated, evidence, 0, 5), Bearing::estimated, {.unknown_start = true, .poisoned = 5}},
      {"start30", params(iterated, evidence, 0, 30), Bearing::estimated, dark},
      {"start30_lag5_marginal",
       sized(marginal(params(iterated, uniform, 5, 30)), 16),
       Bearing::estimated,
       {.bad_matches = true}},
      {"start30_rolling",
       params(iterated, evidence, 3, 30),
       Bearing::estimated,
       {.rolling = true, .unknown_start = true}},
  };
}

// Traces of all settings, by `threads` threads. The values do not depend on the number of threads.
std::vector<Trace> Run(const std::vector<Setting>& settings, unsigned threads, bool text) {
  std::vector<Trace> traces(settings.size(), Trace(text));
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t i = next++; i < settings.size(); i = next++) Player(settings[i], traces[i]).Play();
  };
  std::vector<std::jthread> pool;
  for (unsigned t = 1; t < threads; ++t) pool.emplace_back(work);
  work();
  return pool.clear(), traces;
}

// Digest of values of the C library's mathematical functions.
std::uint64_t LibraryDigest() {
  Trace trace(false);
  for (int i = 1; i <= 2000; ++i) {
    const double x = 0.00137 * i, y = 2.7 - 0.0011 * i;
    for (const double value : {std::sin(x), std::cos(x), std::exp(-x), std::log(x), std::atan2(x, y), std::pow(x, y)})
      trace.Add(value);
  }
  return trace.digest();
}

std::string Key() {
  char key[160];
  std::snprintf(key, sizeof key, "libm-%08x/%s-%d/eigen-%d.%d.%d", static_cast<unsigned>(LibraryDigest()),
#ifdef __clang__
                "clang", __clang_major__,
#else
                "gcc", __GNUC__,
#endif
                EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION);
  return key;
}

std::string Hex(std::uint64_t digest) {
  char text[32];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(digest));
  return text;
}

std::map<std::string, std::string> KnownDigests(const std::string& key) {
  std::map<std::string, std::string> known;
  std::ifstream file(VOBENCH_SOURCE_DIR "/tests/consistency/bit_trace_digests.txt");
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string of, name, digest;
    if (words >> of >> name >> digest && of == key) known[name] = digest;
  }
  return known;
}

int Differences(const std::map<std::string, std::string>& expected, const std::map<std::string, std::string>& found) {
  int differences = expected.size() != found.size();
  for (const auto& [name, digest] : found) {
    const auto other = expected.find(name);
    if (other != expected.end() && other->second == digest) continue;
    std::printf("differs: %s %s, expected %s\n", name.c_str(), digest.c_str(),
                other == expected.end() ? "none" : other->second.c_str());
    ++differences;
  }
  return differences;
}

std::map<std::string, std::string> DigestsOf(const std::vector<Setting>& settings, const std::vector<Trace>& traces) {
  std::map<std::string, std::string> digests;
  Trace total(false);
  for (std::size_t i = 0; i < settings.size(); ++i) {
    digests[settings[i].name] = Hex(traces[i].digest());
    total.Add(static_cast<double>(traces[i].digest() >> 32));
    total.Add(static_cast<double>(traces[i].digest() & 0xffffffffu));
  }
  digests["total"] = Hex(total.digest());
  return digests;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string option = argc > 1 ? argv[1] : "";
  const std::vector<Setting> settings = Settings();
  const std::string key = Key();
  const std::vector<Trace> traces = Run(settings, 2, option == "--text");
  if (option == "--text") {
    for (std::size_t i = 0; i < settings.size(); ++i)
      std::printf("== %s%s\n", settings[i].name.c_str(), traces[i].text().c_str());
    return 0;
  }
  const std::map<std::string, std::string> digests = DigestsOf(settings, traces);
  if (option == "--digests") {
    for (const auto& [name, digest] : digests) std::printf("%s %s %s\n", key.c_str(), name.c_str(), digest.c_str());
    return 0;
  }
  const std::map<std::string, std::string> known = KnownDigests(key);
  if (!known.empty()) return Differences(known, digests) == 0 ? 0 : 1;
  std::printf("no digests are known for %s (kernels: %s): one thread against three; total %s\n", key.c_str(),
              vo::Name(vo::BestInstructionSet()), digests.at("total").c_str());
  if (Differences(DigestsOf(settings, Run(settings, 1, false)), DigestsOf(settings, Run(settings, 3, false))) > 0)
    return 1;
  return 77;
}

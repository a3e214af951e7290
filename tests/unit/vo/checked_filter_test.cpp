// Non-finite numbers and invalid covariances in every part of a filter's state, inputs and outputs: none passes for an
// answer.
#include "vo/filter/checked_filter.h"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tests/unit/vo/at_once.h"
#include "tests/unit/vo/wall.h"
#include "vo/filter/algorithm1.h"
#include "vo/filter/ekf_slam.h"
#include "vo/filter/particle_filter.h"
#include "vo/filter/window_phase.h"
#include "vo/geometry/so3.h"
#include "vo/point_odometry.h"

namespace {

using testing::HasSubstr;
using testing::StartsWith;

constexpr int kLandmarks = 30, kPoisoned = 6, kFrames = 10;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInf = std::numeric_limits<double>::infinity();

std::vector<vo::FirstView> FirstViews() { return vo_test::WallFirstViews(kLandmarks); }
std::vector<vo::Match> Matches(int frame) { return vo_test::WallMatches(kLandmarks, frame); }

vo::FilterPrior Prior() {
  vo::FilterPrior prior;
  prior.velocity_covariance = 0.04 * vo::Matrix6::Identity();
  return prior;
}

vo::FilterParams Plain() {
  vo::FilterParams params = vo_test::SampledAtOnce();
  params.start_window = 0;
  return params;
}

std::unique_ptr<vo::ParticleFilter> MakeParticles(const vo::FilterParams& params) {
  return std::make_unique<vo::ParticleFilter>(vo::MotionParams{}, params, vo::LandmarkParams{}, Prior(), 4);
}

struct Seen {
  std::vector<vo::Belief> beliefs;  // after each frame
  vo::NumericalEvents events;       // of all frames
  std::optional<vo::FilterFault> fault;
};

// Calls of an odometry to its filter, frame by frame; `before` is called ahead of each, `between` after the prediction.
Seen Play(std::unique_ptr<vo::Filter> filter, const std::function<void(int)>& before,
          const std::function<void(int)>& between = {}) {
  Seen seen;
  vo::CheckedFilter checked(std::move(filter));
  std::vector<int> all;
  for (int n = 0; n < kLandmarks; ++n) all.push_back(n);
  try {
    checked.AddLandmarks(FirstViews());
    for (int frame = 1; frame <= kFrames; ++frame) {
      if (before) before(frame);
      checked.Predict(1.0 / 30);
      if (between) between(frame);
      checked.PredictImages(all);
      checked.Update(Matches(frame));
      checked.LandmarkBeliefs();
      checked.LandmarkSpreads();
      seen.events += checked.answer().events;
      seen.beliefs.push_back(checked.belief());
    }
  } catch (const vo::FilterFault& fault) {
    seen.fault = fault;
  }
  return seen;
}

bool Same(const Seen& a, const Seen& b) {
  if (a.beliefs.size() != b.beliefs.size()) return false;
  for (std::size_t k = 0; k < a.beliefs.size(); ++k) {
    if (a.beliefs[k].pose.p_WC != b.beliefs[k].pose.p_WC || a.beliefs[k].covariance != b.beliefs[k].covariance)
      return false;
  }
  return true;
}

// Mutable state of one particle: no image leads to the values that a test sets.
struct State {
  State(const vo::ParticleFilter& filter, std::size_t i) : particle(const_cast<vo::Particle&>(filter.particles()[i])) {
    if (dynamic_cast<const vo::WindowPhase*>(&filter.phase())) solution = &particle.solution;
    if (const auto* algorithm = dynamic_cast<const vo::Algorithm1*>(&filter.phase()))
      prediction = const_cast<vo::PoseGaussian*>(&algorithm->predictions()[i]);
  }
  vo::Particle& particle;
  vo::PathSolution* solution = nullptr;
  vo::PoseGaussian* prediction = nullptr;
};

struct Poison {
  const char* name;
  std::function<void(const State&, double)> put;
};

const Poison kState[] = {
    {"position", [](const State& s, double v) { s.particle.pose.p_WC.y() = v; }},
    {"orientation", [](const State& s, double v) { s.particle.pose.q_WC.x() = v; }},
    {"velocity", [](const State& s, double v) { s.particle.velocity.mean[4] = v; }},
    {"velocity's covariance", [](const State& s, double v) { s.particle.velocity.covariance(2, 2) = v; }},
    {"landmark", [](const State& s, double v) { s.particle.landmarks[7].mean.z() = v; }},
    {"landmark's covariance", [](const State& s, double v) { s.particle.landmarks[7].covariance(2, 2) = v; }},
    {"all landmarks' covariances",
     [](const State& s, double v) {
       for (vo::Landmark& l : s.particle.landmarks) l.covariance(2, 2) = v;
     }},
    {"anchor", [](const State& s, double v) { s.particle.anchors[0].p_WC.x() = v; }},
    {"weight", [](const State& s, double v) { s.particle.log_weight = v; }},
    {"path",
     [](const State& s, double v) {
       if (s.solution && !s.solution->path.mean.empty()) s.solution->path.mean.back().p_WC.z() = v;
     }},
    {"path's covariance",
     [](const State& s, double v) {
       if (s.solution && s.solution->path.covariance.size() > 0) s.solution->path.covariance(1, 1) = v;
     }},
    {"mode",
     [](const State& s, double v) {
       if (s.solution) s.solution->modes[7].x() = v;
     }},
    {"prediction",
     [](const State& s, double v) {
       if (s.prediction) s.prediction->mean.p_WC.x() = v;
     }},
    {"prediction's covariance",
     [](const State& s, double v) {
       if (s.prediction) s.prediction->covariance(3, 3) = v;
     }},
};

struct Member {
  const char* name;
  vo::FilterParams params;
};

std::vector<Member> Members() {
  std::vector<Member> members = {{"evidence", Plain()},     {"importance", Plain()},       {"lag", Plain()},
                                 {"start_window", Plain()}, {"velocity_sampled", Plain()}, {"bootstrap", Plain()},
                                 {"ukf", Plain()}};
  members[1].params.weight = vo::Weight::importance;
  members[2].params.lag = 3;
  members[2].params.weight = vo::Weight::uniform;
  members[3].params.start_window = 4;
  members[4].params.sampled = vo::Sampled::pose_and_velocity;
  members[5].params.proposal = vo::Proposal::bootstrap;
  members[5].params.weight = vo::Weight::importance;
  members[6].params.proposal = vo::Proposal::ukf;
  return members;
}

class CheckedMember : public testing::TestWithParam<Member> {};

// Non-finite value in one particle or all, between frames or after the prediction. A fault names this frame or one of
// the next four, or a guard's count differs, or the value is unused and every answer is the same.
TEST_P(CheckedMember, NonFiniteStateIsCaught) {
  const Seen healthy = Play(MakeParticles(GetParam().params), {});
  ASSERT_FALSE(healthy.fault) << healthy.fault->what();
  int faults = 0, guarded = 0;
  for (const Poison& poison : kState) {
    for (const double value : {kNan, kInf, -kInf}) {
      for (const bool all : {false, true}) {
        for (const bool between : {false, true}) {
          std::unique_ptr<vo::ParticleFilter> filter = MakeParticles(GetParam().params);
          const vo::ParticleFilter& particles = *filter;
          const auto put = [&](int frame) {
            if (frame != kPoisoned) return;
            for (std::size_t i = 0; i < particles.particles().size(); ++i)
              if (all || i == 3) poison.put({particles, i}, value);
          };
          const Seen seen = between ? Play(std::move(filter), {}, put) : Play(std::move(filter), put);
          SCOPED_TRACE(std::string(poison.name) + (all ? " of all" : " of one") +
                       (between ? ", after the prediction: " : ": ") + std::to_string(value) +
                       (seen.fault ? std::string(", ") + seen.fault->what() : ""));
          for (const vo::Belief& belief : seen.beliefs) {
            EXPECT_TRUE(belief.pose.p_WC.allFinite() && belief.velocity.allFinite() && belief.covariance.allFinite());
          }
          if (seen.fault) {
            EXPECT_GE(seen.fault->frame(), kPoisoned);
            EXPECT_LE(seen.fault->frame(), kPoisoned + 4);
            EXPECT_THAT(seen.fault->what(), StartsWith("frame " + std::to_string(seen.fault->frame()) + ", "));
            ++faults;
          } else if (!(seen.events == healthy.events)) {
            ++guarded;
          } else {
            EXPECT_TRUE(Same(seen, healthy)) << "other answers, and nobody says why";
          }
        }
      }
    }
  }
  EXPECT_GT(faults, 0);
  EXPECT_GT(guarded, 0);
}

INSTANTIATE_TEST_SUITE_P(Family, CheckedMember, testing::ValuesIn(Members()),
                         [](const auto& member) { return std::string(member.param.name); });

// Impossible particle, one of eight: it is counted and replaced, and the others go on.
TEST(CheckedFilter, AnImpossibleParticleIsReplacedAndCounted) {
  std::unique_ptr<vo::ParticleFilter> filter = MakeParticles(Plain());
  vo::ParticleFilter& particles = *filter;
  const Seen seen = Play(std::move(filter), {}, [&](int frame) {
    if (frame == kPoisoned) State(particles, 3).particle.log_weight = kNan;
  });
  ASSERT_FALSE(seen.fault) << seen.fault->what();
  EXPECT_EQ(seen.events.non_finite_weight, 1);
  const Seen healthy = Play(MakeParticles(Plain()), {});
  EXPECT_LT((seen.beliefs.back().pose.p_WC - healthy.beliefs.back().pose.p_WC).norm(), 0.05);
}

// All eight particles impossible at once: each is counted once, and the weights are finite from then on.
TEST(CheckedFilter, WhereAllAreImpossibleTheWeightsBeginAgain) {
  for (const int window : {0, 3, 6}) {
    vo::FilterParams params = Plain();
    params.lag = window == 3 ? 3 : 0;
    params.start_window = window == 6 ? 6 : 0;
    std::unique_ptr<vo::ParticleFilter> filter = MakeParticles(params);
    vo::ParticleFilter& particles = *filter;
    const Seen seen = Play(std::move(filter), {}, [&](int frame) {
      for (std::size_t i = 0; i < particles.particles().size(); ++i) {
        double& log_weight = State(particles, i).particle.log_weight;
        if (frame == kPoisoned) log_weight = kNan;
        EXPECT_EQ(std::isfinite(log_weight), frame != kPoisoned) << window;
      }
    });
    ASSERT_FALSE(seen.fault) << seen.fault->what();
    EXPECT_EQ(seen.events.non_finite_weight, params.particles) << window;
  }
}

// Invalid inputs of the filter.
TEST(CheckedFilter, RefusesWhatIsNoMeasurement) {
  using Tell = std::function<void(vo::Filter&)>;
  const auto with_match = [](const std::function<void(vo::Match&)>& spoil) {
    return [spoil](vo::Filter& filter) {
      filter.Predict(0.1);
      std::vector<vo::Match> matches = Matches(1);
      spoil(matches[11]);
      filter.Update(matches);
    };
  };
  const auto with_view = [](const std::function<void(vo::FirstView&)>& spoil) {
    return [spoil](vo::Filter& filter) {
      std::vector<vo::FirstView> views = FirstViews();
      spoil(views[11]);
      filter.AddLandmarks(views);
    };
  };
  const std::pair<Tell, const char*> cases[] = {
      {[](vo::Filter& f) { f.Predict(kNan); }, "frame 1, prediction: the time since the last frame is not positive"},
      {[](vo::Filter& f) { f.Predict(0); }, "frame 1, prediction: the time since the last frame is not positive"},
      {with_match([](vo::Match& m) { m.z.x() = kNan; }), "frame 1, update: a match is at no point of the image"},
      {with_match([](vo::Match& m) { m.R.setZero(); }),
       "frame 1, update: the noise of a match is not positive definite"},
      {with_match([](vo::Match& m) { m.R(1, 1) = kInf; }),
       "frame 1, update: the noise of a match is not positive definite"},
      {with_match([](vo::Match& m) { m.landmark = kLandmarks; }),
       "frame 1, update: a match is of a landmark that is not in the map"},
      {with_view([](vo::FirstView& v) { v.ray.y() = kInf; }),
       "frame 0, new landmarks: a first view is at no point of the image"},
      {with_view([](vo::FirstView& v) { v.R.setZero(); }),
       "frame 0, new landmarks: the noise of a first view is not positive definite"},
      {with_view([](vo::FirstView& v) {
         v.depth = vo::KnownDepth{0.5, 0};
       }),
       "frame 0, new landmarks: a known depth is not positive"},
      {[](vo::Filter& f) { f.KeepLandmarks({true}); },
       "frame 0, forgetting: the number of landmarks given is not that of the map"},
  };
  for (const auto& told : cases) {
    vo::CheckedFilter filter(MakeParticles(Plain()));
    filter.AddLandmarks(FirstViews());
    EXPECT_THAT([&] { told.first(filter); }, (testing::ThrowsMessage<vo::FilterFault>(testing::StrEq(told.second))));
  }
}

// Empty map: every member of the family coasts, and accepts new landmarks.
TEST(CheckedFilter, GoesOnWithAnEmptyMap) {
  for (const Member& member : Members()) {
    vo::CheckedFilter filter(MakeParticles(member.params));
    filter.AddLandmarks(FirstViews());
    for (int frame = 1; frame <= 20; ++frame) {
      if (frame == kPoisoned) filter.KeepLandmarks(std::vector<bool>(kLandmarks, false));
      if (frame == 12) filter.AddLandmarks(FirstViews());
      filter.Predict(1.0 / 30);
      const bool empty = frame >= kPoisoned && frame < 12;
      filter.Update(empty ? std::vector<vo::Match>() : Matches(frame < 12 ? frame : frame - 11));
      EXPECT_EQ(filter.LandmarkBeliefs().size(), empty ? 0u : static_cast<std::size_t>(kLandmarks)) << member.name;
    }
  }
}

// Filter whose outputs are corrupted one at a time.
class Broken final : public vo::Filter {
 public:
  vo::EkfSlam good{vo::MotionParams{}, vo_test::SampledAtOnce(), vo::LandmarkParams{}, Prior()};
  std::function<void(vo::PoseGaussian&)> spoil_prediction = [](auto&) {};
  std::function<void(vo::ImagePrediction&)> spoil_image = [](auto&) {};
  std::function<void(vo::Belief&)> spoil_belief = [](auto&) {};
  std::function<void(vo::BeliefComponent&)> spoil_component = [](auto&) {};
  std::function<void(LandmarkBelief&)> spoil_landmark = [](auto&) {};
  std::function<void(vo::PointMoments&)> spoil_point = [](auto&) {};
  double effective = 1;
  std::vector<vo::StartPose> start;

  void PredictAgain(const vo::MotionInput& input) override { good.PredictAgain(input); }
  void Predict(double dt, const vo::MotionInput& /*input*/) override {
    good.Predict(dt);
    prediction_ = good.Reference().prediction;
    spoil_prediction(prediction_);
  }
  const vo::FilterAnswer& Update(std::span<const vo::Match> matches) override {
    answer_ = good.Update(matches);
    answer_.effective_particles = effective;
    answer_.start = start;
    spoil_belief(answer_.belief);
    spoil_component(answer_.mixture[0]);
    return answer_;
  }
  void AddLandmarks(std::span<const vo::FirstView> views) override { good.AddLandmarks(views); }
  void KeepLandmarks(const std::vector<bool>& keep) override { good.KeepLandmarks(keep); }
  int landmark_count() const override { return good.landmark_count(); }
  const vo::FilterAnswer& answer() const override { return answer_; }
  std::vector<vo::ImagePrediction> PredictImages(std::span<const int> landmarks) const override {
    auto predictions = good.PredictImages(landmarks);
    spoil_image(predictions[2]);
    return predictions;
  }
  vo::ReferencePath Reference() const override {
    vo::ReferencePath reference = good.Reference();
    reference.prediction = prediction_;
    return reference;
  }
  std::vector<LandmarkBelief> LandmarkBeliefs() const override {
    auto beliefs = good.LandmarkBeliefs();
    spoil_landmark(beliefs[2]);
    return beliefs;
  }
  std::vector<LandmarkSpread> LandmarkSpreads() const override {
    auto spreads = good.LandmarkSpreads();
    if (spreads[2].place) spoil_point(*spreads[2].place);
    return spreads;
  }

 private:
  vo::PoseGaussian prediction_;
  vo::FilterAnswer answer_;
};

// Invalid outputs of the filter, stage by stage.
TEST(CheckedFilter, RefusesWhatIsNoAnswer) {
  const std::pair<std::function<void(Broken&)>, const char*> cases[] = {
    {[](Broken& f) { f.spoil_prediction = [](auto& p) { p.mean.p_WC.x() = kNan; }; },
     "frame 1, prediction: the pose is not one"},
    {[](Broken& f) { f.spoil_prediction = [](auto& p) { p.covariance.setZero(); }; },
     "frame 1, prediction: the covariance of the pose has a variance of 0"},
    {[](Broken& f) { f.spoil_prediction = [](auto& p) { p.covariance(1, 4) = kInf; }; },
     "frame 1, prediction: the covariance of the pose is not a number"},
    {[](Broken& f) { f.spoil_image = [](auto& p) { p.z.x() = kNan; }; },
     "frame 1, predicted images: a landmark is at no point"},
    {[](Broken& f) { f.spoil_image = [](auto& p) { p.covariance(0, 0) = -1; }; },
     "frame 1, predicted images: the covariance of a landmark's image has a variance of -1"},
    {[](Broken& f) { f.spoil_belief = [](auto& b) { b.pose.q_WC.coeffs() *= 2; }; },
     "frame 1, update: the pose is not one"},
    {[](Broken& f) { f.spoil_belief = [](auto& b) { b.velocity[5] = kInf; }; },
     "frame 1, update: the velocity is not a number"},
    {[](Broken& f) { f.spoil_belief = [](auto& b) { b.covariance(11, 0) = kNan; }; },
     "frame 1, update: the covariance of pose and velocity is not"},
    {[](Broken& f) { f.spoil_belief = [](auto& b) { b.covariance(3, 3) = -1e-9; }; },
     "frame 1, update: the covariance of pose and velocity has"},
    {[](Broken& f) { f.spoil_belief = [](auto& b) { b.covariance(7, 2) += 1e-3; }; },
     "frame 1, update: the covariance of pose and velocity is not symmetric"},
#if !defined(NDEBUG)
    {[](Broken& f) {
       f.spoil_belief = [](auto& b) {
         b.covariance(7, 2) = b.covariance(2, 7) = 2 * std::sqrt(b.covariance(2, 2) * b.covariance(7, 7));
       };
     },
     "frame 1, update: the covariance of pose and velocity has a negative eigenvalue"},
#endif
    {[](Broken& f) { f.spoil_component = [](auto& c) { c.weight = kNan; }; },
     "frame 1, update: a weight is negative or not a number"},
    {[](Broken& f) { f.spoil_component = [](auto& c) { c.weight = 0.5; }; },
     "frame 1, update: the weights do not sum to 1"},
    {[](Broken& f) {
       f.start = {{0, {}}, {1, {{0, kNan, 0}}}};
     },
     "frame 1, update: a pose of the start is not one"},
    {[](Broken& f) { f.effective = kNan; }, "frame 1, update: the effective number of particles is not one"},
    {[](Broken& f) { f.spoil_landmark = [](auto& l) { l.X_W.z() = kInf; }; },
     "frame 1, landmarks: a landmark is nowhere"},
    {[](Broken& f) { f.spoil_landmark = [](auto& l) { l.inverse_depth_sigma = kNan; }; },
     "frame 1, landmarks: the variance of an inverse depth"},
    {[](Broken& f) { f.spoil_point = [](auto& p) { p.mean.x() = kNan; }; },
     "frame 1, landmarks: a landmark is nowhere"},
    {[](Broken& f) { f.spoil_point = [](auto& p) { p.covariance(2, 2) = -1; }; },
     "frame 1, landmarks: the covariance of a landmark has a variance"},
  };
  for (const auto& [spoil, message] : cases) {
    auto broken = std::make_unique<Broken>();
    spoil(*broken);
    const Seen seen = Play(std::move(broken), {});
    ASSERT_TRUE(seen.fault) << message;
    EXPECT_THAT(seen.fault->what(), StartsWith(message));
  }
  EXPECT_FALSE(Play(std::make_unique<Broken>(), {}).fault) << "unspoilt";
  auto denormal = std::make_unique<Broken>();  // a second particle of the least weight
  denormal->spoil_belief = [](auto& b) {
    b.covariance.row(2).setZero();
    b.covariance.col(2).setZero();
    b.covariance(2, 2) = 2e-316;
    b.covariance(7, 2) = b.covariance(2, 7) = 1e-157;
  };
  EXPECT_FALSE(Play(std::move(denormal), {}).fault);
}

// Points farther than 80 degrees from the axis of a fisheye lens: they have a pixel, but no place on the plane z = 1.
TEST(PointOdometry, LeavesOutWhatAFisheyeSeesBesideIt) {
  const vo::Camera camera{.width = 640, .height = 480, .fx = 100, .fy = 100, .lens = vo::Lens::fisheye};
  vo::PointOdometry odometry(camera, vo::Params(), vo::Prior(), 1);
  const double inside = 319.5 + 100 * 1.39, beside = 319.5 + 100 * 1.41;
  EXPECT_EQ(odometry.Track({0, {{7, {inside, 239.5}}, {8, {beside, 239.5}}}}).diagnostics.landmarks, 1);
  const vo::Estimate next = odometry.Track({33'000'000, {{7, {beside, 239.5}}, {8, {inside, 239.5}}}});
  EXPECT_EQ(next.diagnostics.searched, 0);
  EXPECT_EQ(next.diagnostics.landmarks, 2);
}

TEST(PointOdometry, AnIdIsAnyWholeNumber) {
  vo::PointOdometry odometry({640, 480, 525, 525, 319.5, 239.5}, vo::Params(), vo::Prior(), 1);
  const std::vector<std::int64_t> ids = {5'000'000'000, -7, std::numeric_limits<std::int64_t>::max()};
  odometry.Track({0, {{ids[0], {100, 100}}, {ids[1], {200, 100}}, {ids[2], {300, 100}}}});
  const std::vector<vo::MapPoint> map = odometry.Map();
  ASSERT_EQ(map.size(), ids.size());
  for (std::size_t n = 0; n < ids.size(); ++n) EXPECT_EQ(map[n].id, ids[n]);
}

// Invalid input: refused without a change of the state.
TEST(PointOdometry, RefusesWhatIsNoPointAndNoPrior) {
  const vo::Camera camera{640, 480, 525, 525, 319.5, 239.5};
  vo::Prior prior;
  prior.pose.p_WC.x() = kNan;
  prior.velocity_covariance(0, 5) = 1;
  EXPECT_THAT([&] { vo::PointOdometry(camera, vo::Params(), prior, 1); },
              (testing::ThrowsMessage<std::invalid_argument>(
                  "prior: the pose is not one\nprior: the covariance of the velocity is not one")));
  vo::PointOdometry spoilt(camera, vo::Params(), vo::Prior(), 1), other(camera, vo::Params(), vo::Prior(), 1);
  const auto frame = [](std::int64_t k) {
    vo::PointFrame result{k * 33'000'000, {}};
    for (int n = 0; n < 20; ++n) result.observations.push_back({n, {30.0 * n + static_cast<double>(k), 200 + 7.0 * n}});
    return result;
  };
  for (std::int64_t k = 0; k < 4; ++k) {
    vo::PointFrame bad = frame(k);
    bad.observations[5].pixel.y() = kNan;
    const std::string where = " in the frame at " + std::to_string(bad.stamp_ns) + " ns";
    EXPECT_THAT([&] { spoilt.Track(bad); },
                (testing::ThrowsMessage<std::invalid_argument>("point 5 is nowhere" + where)));
    bad = frame(k);
    bad.observations.push_back(bad.observations[3]);
    EXPECT_THAT([&] { spoilt.Track(bad); },
                (testing::ThrowsMessage<std::invalid_argument>("point 3 comes twice" + where)));
    EXPECT_EQ(spoilt.Track(frame(k)).pose.p_WC, other.Track(frame(k)).pose.p_WC);
  }
}

}  // namespace

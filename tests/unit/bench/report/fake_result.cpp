#include "tests/unit/bench/report/fake_result.h"

#include <cmath>
#include <fstream>

#include "tests/unit/judge/evaluation/random.h"
#include "tools/base/files.h"
#include "tools/base/text.h"
#include "tools/bench/result/pictures.h"
#include "tools/judge/evaluation/text_file.h"

namespace vobench::report {
namespace {

namespace ev = evaluation;
using ev::TestRandom;

// A spiral in a room, the camera upright (y up in the world, so C's y points to -y) and turning as it goes.
ev::StampedPose PoseAt(double t) {
  ev::StampedPose pose;
  pose.stamp_ns = 1'000'000'000 + static_cast<std::int64_t>(std::llround(t * 1e9));
  const double angle = 0.6 * t, radius = 0.5 + 0.12 * t;
  pose.p_WC = {radius * std::sin(angle), 1.4 + 0.1 * std::sin(2.1 * t), radius * (std::cos(angle) - 1)};
  const Eigen::Quaterniond upright(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()));
  pose.q_WC = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()) * upright *
              ev::Exp({0.06 * std::sin(1.7 * t), 0, 0.04 * std::sin(t)});
  return pose;
}

ev::StampedVelocity VelocityAt(double t) {
  const double h = 1e-4;
  const ev::StampedPose before = PoseAt(t - h), after = PoseAt(t + h);
  return {PoseAt(t).stamp_ns, (after.p_WC - before.p_WC) / (2 * h),
          ev::Log(before.q_WC.conjugate() * after.q_WC) / (2 * h)};
}

ev::EstimateRun FakeRun(const FakeSystem& system, int frames, TestRandom& random) {
  ev::EstimateRun run;
  Eigen::Vector3d dp = Eigen::Vector3d::Zero(), dphi = dp;
  const double dt = 1.0 / 30, sigma_v = 0.02, sigma_w = 0.015;
  const ev::StampedPose start = PoseAt(0);
  for (int k = 0; k < frames; ++k) {
    const double t = k * dt;
    const ev::StampedPose truth = PoseAt(t);
    const ev::StampedVelocity velocity = VelocityAt(t);
    if (k > 0) {
      dp += system.drift * std::sqrt(dt) * random.Normals(3);
      dphi += system.drift / 2 * std::sqrt(dt) * random.Normals(3);
    }
    run.trajectory.push_back(
        {truth.stamp_ns, start.p_WC + system.scale * (truth.p_WC - start.p_WC) - dp, truth.q_WC * ev::Exp(-dphi)});
    ev::Vector12d variance;
    const double walked = std::max(1e-12, system.drift * system.drift * t);
    variance << Eigen::Vector3d::Constant(walked), Eigen::Vector3d::Constant(walked / 4),
        Eigen::Vector3d::Constant(sigma_v * sigma_v), Eigen::Vector3d::Constant(sigma_w * sigma_w);
    const Eigen::Vector3d ev_ = sigma_v * random.Normals(3), ew = sigma_w * random.Normals(3);
    run.beliefs.push_back({{truth.stamp_ns, velocity.v_WC - ev_, velocity.w_WC_C - ew},
                           ev::Matrix12d((system.claimed * system.claimed * variance).asDiagonal())});
    ev::FrameRecord frame;
    frame.stamp_ns = truth.stamp_ns;
    frame.searched = 70 + static_cast<int>(20 * std::sin(1.3 * t) + 5 * random.Uniform());
    const bool blur = t > 1.5 && t < 1.8;
    frame.matched =
        blur ? static_cast<int>(9 * random.Uniform()) : frame.searched - static_cast<int>(20 * random.Uniform());
    frame.landmarks = 60 + 2 * k;
    frame.permanent = std::max(0, k - 30);
    frame.nis_dof = 2 * frame.matched;
    frame.nis =
        frame.nis_dof == 0 ? 0 : random.Normals(frame.nis_dof).squaredNorm() / (system.claimed * system.claimed);
    frame.effective_particles = 3 + 5 * random.Uniform();
    frame.ms_features = 4 + random.Uniform(), frame.ms_matching = 6 + 2 * random.Uniform(), frame.ms_filter = 3;
    frame.tracked = frame.matched >= 10;
    run.frames.push_back(frame);
  }
  if (system.reissued) run.live = run.trajectory;
  for (int k = 0; k < std::min(20, frames) && system.reissued; ++k)
    run.trajectory[k].p_WC = (run.trajectory[k].p_WC + PoseAt(k * dt).p_WC) / 2;
  return run;
}

std::string Landmarks(TestRandom& random) {
  std::string text = "id,x,y,z,inverse_depth,inverse_depth_sigma,permanent\n";
  for (int i = 0; i < 400; ++i) {  // on the walls of a room of 5 m
    Eigen::Vector3d p =
        5 * Eigen::Vector3d{random.Uniform(), 0.6 * random.Uniform(), random.Uniform()} - Eigen::Vector3d(2.5, 0, 3);
    p[i % 2 == 0 ? 0 : 2] = i % 4 < 2 ? -2.6 : 2.2;
    text += std::to_string(i);
    for (int k = 0; k < 3; ++k) text += "," + base::Significant(p[k], 9);
    text += ",0.4,0.01," + std::string(i % 5 == 0 ? "0" : "1") + "\n";
  }
  return text;
}

FeatureMark FakeFeature(int i, TestRandom& random) {
  FeatureMark mark;
  mark.status = static_cast<FeatureMark::Status>(i % 4);
  mark.predicted = {640 * random.Uniform(), 480 * random.Uniform()};
  mark.pixel = mark.predicted + Eigen::Vector2d(random.Normals(2));
  mark.covariance << 9, 2, 2, 4;
  return mark;
}

// The smallest JPEG there is: one grey pixel.
const unsigned char kJpeg[] = {
    0xFF, 0xD8, 0xFF, 0xDB, 0x00, 0x43, 0x00, 0x03, 0x02, 0x02, 0x02, 0x02, 0x02, 0x03, 0x02, 0x02, 0x02, 0x03,
    0x03, 0x03, 0x03, 0x04, 0x06, 0x04, 0x04, 0x04, 0x04, 0x04, 0x08, 0x06, 0x06, 0x05, 0x06, 0x09, 0x08, 0x0A,
    0x0A, 0x09, 0x08, 0x09, 0x09, 0x0A, 0x0C, 0x0F, 0x0C, 0x0A, 0x0B, 0x0E, 0x0B, 0x09, 0x09, 0x0D, 0x11, 0x0D,
    0x0E, 0x0F, 0x10, 0x10, 0x11, 0x10, 0x0A, 0x0C, 0x12, 0x13, 0x12, 0x10, 0x13, 0x0F, 0x10, 0x10, 0x10, 0xFF,
    0xC9, 0x00, 0x0B, 0x08, 0x00, 0x01, 0x00, 0x01, 0x01, 0x01, 0x11, 0x00, 0xFF, 0xCC, 0x00, 0x06, 0x00, 0x10,
    0x10, 0x05, 0xFF, 0xDA, 0x00, 0x08, 0x01, 0x01, 0x00, 0x00, 0x3F, 0x00, 0xD2, 0xCF, 0x20, 0xFF, 0xD9};

}  // namespace

std::vector<RunMetrics> WriteFakeResult(const std::filesystem::path& out, const FakeOptions& options) {
  RunDescription description;
  description.title = "A spiral in a room";
  description.input = "scenes/spiral & <co>.yaml";
  description.command =
      "vobench run scenes/spiral.yaml --runs " + std::to_string(options.seeds) + " --system rb2pf,rbpf";
  description.started_utc = "2026-01-31T12:00:00Z";
  description.seconds = 61.5;
  description.settings = "filter:\n  particles: 8\n";
  description.versions = {{"vobench", "0.1.0"}, {"Eigen", "3.4.0"}};
  std::vector<RunMetrics> judged;
  for (const FakeSystem& system : options.systems) {
    for (int seed = 1; seed <= options.seeds; ++seed) {
      TestRandom random(static_cast<std::uint32_t>(seed + 100 * static_cast<int>(system.name.size())));
      RunEntry entry{system.name, static_cast<std::uint64_t>(seed), system.name + "/seed_" + std::to_string(seed), 9.5};
      const auto folder = out / entry.path;
      std::filesystem::create_directories(folder / "frames");
      const ev::EstimateRun run = FakeRun(system, options.frames, random);
      ev::WriteEstimateRun(folder, run);
      base::WriteFile(folder / "landmarks.csv", Landmarks(random));
      if (options.pictures) {
        KeptPictures kept{640, 480, {}};
        for (int k = 4; k < options.frames; k += options.frames / 12 + 1) {
          KeptPicture& picture = kept.pictures.emplace_back();
          picture.stamp_ns = run.trajectory[static_cast<std::size_t>(k)].stamp_ns;
          for (int i = 0; i < 40; ++i) picture.features.push_back(FakeFeature(i, random));
          base::WriteFile(folder / PicturePath(picture.stamp_ns),
                          std::string(reinterpret_cast<const char*>(kJpeg), sizeof kJpeg));
        }
        WritePictures(folder, kept);
      }
      if (options.truth) {
        ev::Trajectory truth;
        ev::Velocities velocities;
        for (int k = 0; k < options.frames; ++k) {
          truth.push_back(PoseAt(k / 30.0));
          velocities.push_back(VelocityAt(k / 30.0));
        }
        ev::WriteTrajectory(folder / "truth.txt", truth);
        ev::WriteVelocities(folder / "truth_velocity.txt", velocities);
        judged.push_back({entry, ev::Judge(run, truth, velocities)});
      }
      description.runs.push_back(entry);
    }
  }
  WriteRunJson(out, description);
  if (!judged.empty()) WriteMetricsJson(out, judged);
  return judged;
}

}  // namespace vobench::report

// Independence of the unit of length: the scale of a single camera is unobservable, so that a factor on all lengths of
// the priors is a factor on all lengths of the estimate. Recorded sequences, with the settings of `vobench track`.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/system/recorded.h"
#include "vo/geometry/camera_file.h"
#include "vo/odometry.h"
#include "vo/sequence/reader.h"

namespace vobench::system_test {
namespace {

struct Lengths {
  double factor = 1;
  bool noise_too = true;  // false: control
};

// Positions divided by the factor [m].
std::vector<Eigen::Vector3d> Track(const std::filesystem::path& sequence, const vo::Camera& camera, int frames,
                                   const Lengths& lengths) {
  const double s = lengths.factor;
  vo::Params params;
  if (lengths.noise_too) params.motion.position_noise *= s;
  params.landmark.inverse_depth /= s;
  params.landmark.inverse_depth_sigma /= s;
  vo::Prior prior;
  prior.pose_covariance = 1e-12 * vo::Matrix6::Identity();
  for (vo::Matrix6* covariance : {&prior.pose_covariance, &prior.velocity_covariance})
    covariance->topLeftCorner<3, 3>() *= s * s;
  vo::Odometry odometry(camera, params, prior, 1);
  vo::SequenceReader reader(sequence);
  std::vector<Eigen::Vector3d> positions;
  for (int k = 0; k < frames; ++k) {
    const std::optional<vo::Frame> frame = reader.Next();
    if (!frame) break;
    positions.push_back(odometry.Track(*frame).pose.p_WC / s);
  }
  return positions;
}

// Largest difference of two positions over the extent of the first path.
double Difference(const std::vector<Eigen::Vector3d>& a, const std::vector<Eigen::Vector3d>& b) {
  double extent = 0, difference = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    extent = std::max(extent, (a[k] - a[0]).norm());
    difference = std::max(difference, (a[k] - b[k]).norm());
  }
  return difference / extent;
}

// Difference below 1e-7: six digits and more of every position, and so of the ATE. A factor that is a power of two
// rounds no product, only sums with constants. Control: motion noise in metres.
void ExpectNoMetre(const std::string& name, const std::string& own_camera) {
  const auto sequence = RecordedSequence(name);
  if (!sequence)
    GTEST_SKIP() << "no recorded sequence " << name << "; VOBENCH_DATA names the folder it is looked for in";
  const vo::Camera camera = vo::CameraFrom(own_camera.empty() ? (*sequence / "camera.yaml").string() : own_camera);
  constexpr int kAll = 100'000;
  const std::vector<Eigen::Vector3d> whole = Track(*sequence, camera, kAll, {});
  ASSERT_GT(whole.size(), 40u);
  for (const int k : {-7, -3, 4, 7})
    EXPECT_LT(Difference(whole, Track(*sequence, camera, kAll, {std::exp2(k)})), 1e-7) << "2^" << k;
  EXPECT_GT(Difference(whole, Track(*sequence, camera, kAll, {8, false})), 1e-4) << "the motion noise in metres";
}

// Factors that are no powers of two: every product is rounded.
TEST(ScaleSlowTest, Freiburg1TakesAnyUnit) {
  const auto sequence = RecordedSequence("tum_fr1_xyz");
  if (!sequence) GTEST_SKIP() << "no recorded sequence tum_fr1_xyz; VOBENCH_DATA names the folder it is looked for in";
  const vo::Camera camera = vo::CameraFrom("freiburg1");
  constexpr int kFirst = 60;
  const std::vector<Eigen::Vector3d> first = Track(*sequence, camera, kFirst, {});
  for (const double factor : {0.01, 0.3, 7.0})
    EXPECT_LT(Difference(first, Track(*sequence, camera, kFirst, {factor})), 1e-6) << factor;
}

TEST(ScaleSlowTest, Freiburg1HasNoMetre) { ExpectNoMetre("tum_fr1_xyz", "freiburg1"); }
TEST(ScaleSlowTest, KittiHasNoMetre) { ExpectNoMetre("kitti_straight", ""); }

}  // namespace
}  // namespace vobench::system_test

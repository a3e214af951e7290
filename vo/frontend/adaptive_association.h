// Association of a frame whose prediction may fail: process noise estimated on line, the prediction repeated with more
// noise, then about the rotation found by direct alignment of the images, then with a wide search. A repetition is kept
// where clearly more matches agree; a frame in which too few agree has no matches.
// Source:  docs/algorithm.md, section 7.1.
#pragma once

#include <functional>
#include <opencv2/core.hpp>
#include <optional>

#include "vo/filter/adaptive_noise.h"
#include "vo/frontend/association.h"

namespace vo {

// Share of the searched landmarks that has to agree with a prediction: false matches near a wrong one may agree with
// it. Two fifths; up to a half where the share is clearly below the usual one of the last ten frames or so. Landmarks
// that come near and pass agree less in every frame.
class UsualAgreement {
 public:
  // Of the next frame, whose first prediction has `agreement`.
  double Least(double agreement);

 private:
  double usual_ = 1;
};

class AdaptiveAssociation {
 public:
  AdaptiveAssociation(const Camera& camera, const MotionParams& motion) : camera_(camera), motion_(motion) {}

  // Correction of the path where the frame shows landmarks that the association does not find; `failed`: its
  // prediction.
  using Relocalise = std::function<std::optional<PathCorrection>(const Association& association, bool failed)>;
  using Associate = std::function<Association(const MotionInput&, Search)>;
  // `associate` is called after each prediction, with its input. `coasting_s`: time from the first frame without
  // matches to the last frame; 0 where that had matches.
  Association PredictAndAssociate(Filter& filter, double dt, double coasting_s, const cv::Mat& grey,
                                  const Associate& associate, const Relocalise& relocalise);

  // Input of the last association, if its first prediction had failed and another was kept.
  const std::optional<MotionInput>& repeated_input() const { return repeated_input_; }
  // The next association, of the same frame, begins with this input.
  void BeginWith(const std::optional<MotionInput>& input) { begin_with_ = input; }

  // Prediction of a frame that is not associated.
  void Predict(Filter& filter, double dt, double coasting_s);

  // Whether `grey` equals the image that was kept last, pixel by pixel: a frame repeated by the camera or the
  // recording, without new information. At most twice in a row: a static, noise-free camera gives equal images too.
  bool IsRepeated(const cv::Mat& grey);

  // `grey`: of a frame whose pose is not integrated out, being that of matches or of new landmarks.
  void Keep(const cv::Mat& grey) { grey.copyTo(last_); }  // the memory is the caller's

 private:
  // Input of the next prediction. A velocity decays with the times of the last frame that had matches.
  MotionInput Input(const Filter& filter, double coasting_s);

  // The input with a turn measured by direct alignment, which determines a rotation and leaves the position to the
  // model, but for the start, whose velocity is not known.
  MotionInput Aligned(const MotionInput& input, const Eigen::Quaterniond& turn, double dt, bool initialising) const;

  Camera camera_;
  MotionParams motion_;
  AdaptiveNoise noise_;
  cv::Mat last_;  // grey image of the last pose
  int repetitions_ = 0;
  UsualAgreement usual_agreement_;
  double position_time_ = kLeastVelocityTime, orientation_time_ = kLeastVelocityTime;
  std::optional<MotionInput> repeated_input_, begin_with_;
};

}  // namespace vo

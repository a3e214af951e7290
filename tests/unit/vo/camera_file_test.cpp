// Calibration files of other tools: parameters read from them, and error messages for files that are refused.
#include "vo/geometry/camera_file.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>

#include "tools/base/settings/problem.h"

namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class CameraFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              ("camera_file_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path Write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  // As the calibration sample of OpenCV writes it.
  fs::path WriteByOpenCv(const std::string& name, const cv::Mat& matrix, const cv::Mat& lens,
                         bool fisheye = false) const {
    const fs::path file = folder_ / name;
    cv::FileStorage storage(file.string(), cv::FileStorage::WRITE);
    storage << "calibration_time"
            << "Sun 22 Nov"
            << "image_width" << 752 << "image_height" << 480;
    if (fisheye) storage << "fisheye_model" << 1;
    storage << "camera_matrix" << matrix << "distortion_coefficients" << lens << "avg_reprojection_error" << 0.2;
    return file;
  }
  static std::string ErrorOf(const fs::path& file) {
    try {
      vo::ReadCamera(file);
    } catch (const settings::Error& error) {
      return error.what();
    }
    return "";
  }

  // Parameters of a lens, and OpenCV's projection of a point with them.
  const cv::Matx33d matrix_{458.5, 0, 367.25, 0, 457.25, 248.375, 0, 0, 1};
  const std::vector<double> radtan_{-0.2834, 0.0739, 0.00019, 1.76e-05, 0.004};
  const std::vector<double> fisheye_{-0.0127, 0.0114, -0.0071, 0.0023};

  static void ExpectSees(const vo::Camera& camera, const cv::Point3d& point, const cv::Point2d& expected) {
    const Eigen::Vector2d pixel = camera.Project({point.x, point.y, point.z});
    EXPECT_NEAR(pixel.x(), expected.x, 1e-9);
    EXPECT_NEAR(pixel.y(), expected.y, 1e-9);
    EXPECT_EQ(camera.width, 752);
    EXPECT_EQ(camera.height, 480);
  }
  void ExpectPlumbBob(const vo::Camera& camera) const {
    std::vector<cv::Point2d> pixels;
    cv::projectPoints(std::vector<cv::Point3d>{{0.3, -0.2, 1.1}}, cv::Vec3d(), cv::Vec3d(), matrix_, radtan_, pixels);
    ExpectSees(camera, {0.3, -0.2, 1.1}, pixels[0]);
  }
  void ExpectFisheye(const vo::Camera& camera) const {
    std::vector<cv::Point2d> pixels;
    cv::fisheye::projectPoints(std::vector<cv::Point3d>{{0.3, -0.2, 1.1}}, pixels, cv::Vec3d(), cv::Vec3d(), matrix_,
                               fisheye_);
    ExpectSees(camera, {0.3, -0.2, 1.1}, pixels[0]);
  }

  fs::path folder_;
};

TEST_F(CameraFile, OfOpenCvInYamlAndXml) {
  for (const char* name : {"c.yaml", "c.yml", "c.xml"}) {
    ExpectPlumbBob(vo::ReadCamera(WriteByOpenCv(name, cv::Mat(matrix_), cv::Mat(radtan_))));
    ExpectPlumbBob(vo::ReadCamera(WriteByOpenCv(name, cv::Mat(matrix_), cv::Mat(radtan_).t())));
    ExpectFisheye(vo::ReadCamera(WriteByOpenCv(name, cv::Mat(matrix_), cv::Mat(fisheye_), true)));
  }
}

TEST_F(CameraFile, OfOpenCvThatIsNotUnderstood) {
  const std::vector<double> rational{0.1, 0, 0, 0, 0, 0.2, 0, 0};
  const fs::path file = WriteByOpenCv("c.yaml", cv::Mat(matrix_).rowRange(0, 2), cv::Mat(rational));
  EXPECT_THAT(ErrorOf(file), HasSubstr(file.string() + ":6:16: 'camera_matrix' must have 3 x 3 numbers"));
  EXPECT_THAT(ErrorOf(file), HasSubstr("'distortion_coefficients'"));
  EXPECT_THAT(ErrorOf(Write("c.xml", "<?xml version=\"1.0\"?>\n<opencv_storage>\n<image_width>-3</image_width>")),
              HasSubstr("c.xml: is cut off"));
  EXPECT_THAT(ErrorOf(WriteByOpenCv("c.xml", cv::Mat(matrix_).rowRange(0, 2), cv::Mat(rational))),
              HasSubstr("c.xml:6:16: 'camera_matrix' must have 3 x 3 numbers"));
  // Malformed files: fewer numbers than rows x cols; a second document, on which OpenCV 4.6's reader never ends.
  const std::string short_matrix =
      "%YAML:1.0\ncamera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   data: [1, 2]\n";
  EXPECT_THAT(ErrorOf(Write("e.yaml", short_matrix)),
              HasSubstr("e.yaml:5:10: 'camera_matrix.data': expected 9 numbers, 3 x 3, not 2"));
  EXPECT_THAT(ErrorOf(Write("f.yaml", "%YAML:1.0\n a: 0\n- 3\n")),
              HasSubstr("f.yaml: holds more than one YAML document"));
  const std::string nothing = ErrorOf(Write("d.yaml", "%YAML:1.0\n---\nimage_width: -3\n"));
  for (const char* key : {"image_width", "image_height", "camera_matrix", "distortion_coefficients"})
    EXPECT_THAT(nothing, HasSubstr(key));
}

// Keys of OpenCV's older samples, in two YAML documents as written by cv::FileStorage::APPEND.
TEST_F(CameraFile, OfOpenCvWithOlderNamesAndAppended) {
  const fs::path file = folder_ / "old.yaml";
  {
    cv::FileStorage storage(file.string(), cv::FileStorage::WRITE);
    storage << "image_Width" << 752 << "image_Height" << 480;
  }
  {
    cv::FileStorage storage(file.string(), cv::FileStorage::APPEND);
    storage << "Camera_Matrix" << cv::Mat(matrix_) << "Distortion_Coefficients" << cv::Mat(radtan_);
  }
  ExpectPlumbBob(vo::ReadCamera(file));
}

// Readout time: 0 only where the file states it, else none.
TEST_F(CameraFile, SaysWhetherTheShutterIsStated) {
  const std::string own = "width: 640\nheight: 480\nfx: 525\nfy: 525\ncx: 319.5\ncy: 239.5\n";
  EXPECT_EQ(vo::ReadCamera(Write("own.yaml", own)).readout_s, std::nullopt);
  EXPECT_EQ(vo::ReadCamera(Write("own.yaml", own + "rolling_shutter: 0 ms\n")).readout_s, 0.0);
  EXPECT_EQ(vo::ReadCamera(Write("own.yaml", own + "rolling_shutter: -26 ms\n")).readout_s, -0.026);
  EXPECT_EQ(vo::ReadCamera(WriteByOpenCv("opencv.yaml", cv::Mat(matrix_), cv::Mat(radtan_))).readout_s, std::nullopt);
  EXPECT_EQ(vo::ReadCamera(WriteByOpenCv("opencv.xml", cv::Mat(matrix_), cv::Mat(radtan_))).readout_s, std::nullopt);
}

TEST_F(CameraFile, OfRos) {
  const std::string text =
      "image_width: 752\nimage_height: 480\ncamera_name: left\ncamera_matrix:\n  rows: 3\n  cols: 3\n"
      "  data: [458.5, 0, 367.25, 0, 457.25, 248.375, 0, 0, 1]\n";
  ExpectPlumbBob(vo::ReadCamera(
      Write("ros.yaml", text + "distortion_model: plumb_bob\ndistortion_coefficients:\n  rows: 1\n  cols: 5\n"
                               "  data: [-0.2834, 0.0739, 0.00019, 1.76e-05, 0.004]\n"
                               "rectification_matrix: {rows: 3, cols: 3, data: [1, 0, 0, 0, 1, 0, 0, 0, 1]}\n")));
  ExpectFisheye(
      vo::ReadCamera(Write("ros.yaml", text + "distortion_model: equidistant\ndistortion_coefficients: {rows: 1, cols: "
                                              "4, data: [-0.0127, 0.0114, -0.0071, 0.0023]}\n")));
  for (const auto& [model, words] : {std::pair("thin_prism", ":8:19: 'distortion_model': 'thin_prism' is not known"),
                                     std::pair("plumb_bob", "there are 2 numbers")}) {
    const std::string lens = std::string("distortion_model: ") + model + "\ndistortion_coefficients: {data: [1, 2]}\n";
    const std::string error = ErrorOf(Write("ros.yaml", text + lens));
    EXPECT_THAT(error, HasSubstr(words));
    EXPECT_EQ(std::ranges::count(error, '\n'), 0) << error;
  }
}

TEST_F(CameraFile, OfKalibr) {
  const std::string first =
      "cam0:\n  camera_model: pinhole\n  intrinsics: [458.5, 457.25, 367.25, 248.375]\n  resolution: [752, 480]\n  "
      "rostopic: /cam0/image_raw\n";
  const std::string second = "cam1:\n  camera_model: omni\n  T_cn_cnm1:\n  - [1, 0, 0, 0]\n";
  std::string radtan =
      first + "  distortion_model: radtan\n  distortion_coeffs: [-0.2834, 0.0739, 0.00019, 1.76e-05]\n";
  const vo::Camera camera = vo::ReadCamera(Write("camchain.yaml", radtan + second));
  EXPECT_EQ(camera.k1, -0.2834);
  EXPECT_EQ(camera.p2, 1.76e-05);
  EXPECT_EQ(camera.k3, 0);
  EXPECT_EQ(camera.fx, 458.5);
  EXPECT_EQ(camera.cy, 248.375);
  ExpectFisheye(vo::ReadCamera(
      Write("camchain.yaml",
            first + "  distortion_model: equidistant\n  distortion_coeffs: [-0.0127, 0.0114, -0.0071, 0.0023]\n")));
  EXPECT_THAT(ErrorOf(Write("camchain.yaml", first + "  distortion_model: fov\n  distortion_coeffs: [0.9]\n")),
              HasSubstr("camchain.yaml:6:"));
}

TEST_F(CameraFile, OfEurocWhoseSizeIsNone) {
  for (const char* width : {"0", "752.5", "1e74"}) {
    const std::string text = std::string("camera_model: pinhole\nresolution: [") + width +
                             ", 480]\nintrinsics: [458.5, 457.25, 367.25, 248.375]\ndistortion_model: none\n"
                             "distortion_coefficients: [0, 0, 0, 0]\n";
    EXPECT_THAT(ErrorOf(Write("sensor.yaml", text)), HasSubstr("sensor.yaml:2:")) << width;
  }
}

// Radial-tangential camera of all file formats below.
void ExpectRadtan(const vo::Camera& c, double k1) {
  EXPECT_EQ(c.width, 752);
  EXPECT_EQ(c.height, 480);
  EXPECT_EQ(c.lens, vo::Lens::radial_tangential);
  EXPECT_NEAR(c.fx, 458.5, 1e-9);
  EXPECT_NEAR(c.fy, 457.25, 1e-9);
  EXPECT_NEAR(c.cx, 367.25, 1e-9);
  EXPECT_NEAR(c.cy, 248.375, 1e-9);
  EXPECT_EQ(c.k1, k1);
  EXPECT_EQ(c.readout_s, std::nullopt);
}

TEST_F(CameraFile, OfColmap) {
  const std::string head = "# Camera list\n#   CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n";
  ExpectRadtan(
      vo::ReadCamera(Write("c.txt", head + "3 OPENCV 752 480 458.5 457.25 367.75 248.875 -0.25 0.07 1e-4 2e-5")),
      -0.25);
  ExpectRadtan(vo::ReadCamera(Write("c.txt", head + "1 PINHOLE 752 480 458.5 457.25 367.75 248.875\r\n")), 0);
  ExpectFisheye(vo::ReadCamera(
      Write("c.txt", head + "1 OPENCV_FISHEYE 752 480 458.5 457.25 367.75 248.875 -0.0127 0.0114 -0.0071 0.0023\n")));
  const vo::Camera simple = vo::ReadCamera(Write("c.txt", "1 SIMPLE_RADIAL 640 480 500 320 240 0.1\n"));
  EXPECT_EQ(simple.fy, 500);
  EXPECT_EQ(simple.cx, 319.5);
  EXPECT_EQ(simple.k1, 0.1);
  EXPECT_THAT(ErrorOf(Write("c.txt", "1 THIN_PRISM_FISHEYE 640 480 1 1 1 1 0 0 0 0 0 0 0 0\n")),
              HasSubstr("COLMAP's model THIN_PRISM_FISHEYE is not known"));
  EXPECT_THAT(ErrorOf(Write("c.txt", "1 OPENCV 640 480 500 500 320 240\n")), HasSubstr("has 8 parameters, not 4"));
  EXPECT_THAT(ErrorOf(Write("c.txt", "1 SIMPLE_PINHOLE 640 480 500 320 240\n2 SIMPLE_PINHOLE 64 48 50 32 24\n")),
              HasSubstr("more than one camera"));
}

TEST_F(CameraFile, OfDso) {
  ExpectRadtan(
      vo::ReadCamera(Write("camera.txt", "RadTan 458.5 457.25 367.25 248.375 -0.25 0.07 1e-4 2e-5\n752 480\n")), -0.25);
  ExpectFisheye(vo::ReadCamera(
      Write("camera.txt", "KannalaBrandt 458.5 457.25 367.25 248.375 -0.0127 0.0114 -0.0071 0.0023\n752 480\n")));
  // LSD-SLAM: no name of the model.
  ExpectRadtan(
      vo::ReadCamera(Write("camera.cfg", "458.5 457.25 367.25 248.375 -0.25 0.07 1e-4 2e-5\n752 480\ncrop\n640 480\n")),
      -0.25);
  ExpectRadtan(vo::ReadCamera(Write("camera.cfg", "458.5 457.25 367.25 248.375 0\n752 480\n")), 0);
  const vo::Camera relative =
      vo::ReadCamera(Write("camera.txt", "Pinhole 0.5 0.75 0.5 0.5 0\n640 480\ncrop\n640 480\n"));
  EXPECT_EQ(relative.fx, 320);
  EXPECT_EQ(relative.cy, 239.5);
  const std::string refused =
      ErrorOf(Write("camera.txt",
                    "0.535719308086809 0.669566858850269 0.493248545285398 0.500408664348414 0.897966\n"
                    "1280 1024\ncrop\n640 480\n"));
  EXPECT_THAT(refused, HasSubstr("field-of-view lens"));
  EXPECT_EQ(std::count(refused.begin(), refused.end(), '\n'), 0);
}

TEST_F(CameraFile, OfOpenCvWithOtherFirstLines) {
  const std::string rest =
      "image_width: 752\nimage_height: 480\ncamera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: "
      "[ "
      "458.5, 0., 367.25, 0., 457.25, 248.375, 0., 0., 1. ]\ndistortion_coefficients: !!opencv-matrix\n   rows: 1\n   "
      "cols: 4\n   dt: d\n   data: [ -0.25, 0.07, 0.0001, 2e-05 ]\n";
  for (const std::string first : {"%YAML:1.0\n---\n", "%YAML 1.0\n---\n", "\xef\xbb\xbf%YAML:1.0\n", "---\n", ""})
    ExpectRadtan(vo::ReadCamera(Write("c.yaml", first + rest)), -0.25);
}

TEST_F(CameraFile, OfKalibrAndOpenVins) {
  const std::string cam =
      "cam0:\n  camera_model: pinhole\n  intrinsics: [458.5, 457.25, 367.25, 248.375]\n  resolution: [752, 480]\n";
  ExpectRadtan(vo::ReadCamera(Write("c.yaml", cam + "  distortion_model: none\n  distortion_coeffs: []\n")), 0);
  ExpectRadtan(vo::ReadCamera(Write("c.yaml", cam + "  distortion_model: none\n")), 0);
  ExpectRadtan(
      vo::ReadCamera(Write(
          "c.yaml", "%YAML:1.0\n\n" + cam + "  distortion_model: radtan\n  distortion_coeffs: [-0.25, 0, 0, 0]\n")),
      -0.25);
  const std::string alone =
      "camera_model: pinhole\nintrinsics: [458.5, 457.25, 367.25, 248.375]\nresolution: [752, 480]\n"
      "distortion_model: radtan\ndistortion_coeffs: [-0.25, 0, 0, 0]\n";
  ExpectRadtan(vo::ReadCamera(Write("c.yaml", alone)), -0.25);
  ExpectRadtan(
      vo::ReadCamera(Write("c.yaml", "cam1: {" + std::string("camera_model: pinhole, distortion_model: none, ") +
                                         "intrinsics: [458.5, 457.25, 367.25, 248.375], resolution: [752, 480]}")),
      0);
  EXPECT_THAT(
      ErrorOf(Write("c.yaml", "%YAML:1.0\nverbosity: INFO\nrelative_config_imucam: kalibr_imucam_chain.yaml\n")),
      HasSubstr("give the file that relative_config_imucam names"));
}

TEST_F(CameraFile, OfOrbSlam) {
  const std::string size = "Camera.width: 752\nCamera.height: 480\nORBextractor.nFeatures: 1000\n";
  for (const std::string prefix : {"Camera.", "Camera1."}) {
    const auto key = [&](const std::string& name, const std::string& value) {
      return prefix + name + ": " + value + "\n";
    };
    const std::string pinhole =
        key("fx", "458.5") + key("fy", "457.25") + key("cx", "367.25") + key("cy", "248.375") + size;
    ExpectRadtan(
        vo::ReadCamera(Write("o.yaml", "%YAML:1.0\n\nCamera.type: \"PinHole\"\n" + pinhole + key("k1", "-0.25") +
                                           key("k2", "0.07") + key("p1", "0.0001") + key("p2", "2e-5"))),
        -0.25);
    ExpectRadtan(vo::ReadCamera(Write("o.yaml", "%YAML:1.0\nCamera.type: \"Rectified\"\n" + pinhole)), 0);
    ExpectFisheye(
        vo::ReadCamera(Write("o.yaml", "%YAML:1.0\nCamera.type: \"KannalaBrandt8\"\n" + pinhole + key("k1", "-0.0127") +
                                           key("k2", "0.0114") + key("k3", "-0.0071") + key("k4", "0.0023"))));
  }
}

TEST_F(CameraFile, OfCamodocalAndVins) {
  const std::string size = "%YAML:1.0\n---\ncamera_name: camera\nimage_width: 752\nimage_height: 480\n";
  ExpectRadtan(vo::ReadCamera(Write(
                   "c.yaml", size + "model_type: PINHOLE\ndistortion_parameters:\n   k1: -2.5e-01\n   k2: 0\n   p1: "
                                    "0\n   p2: 0\nprojection_parameters:\n   fx: 4.585e+02\n   fy: 4.5725e+02\n"
                                    "   cx: 3.6725e+02\n   cy: 2.48375e+02\n")),
               -0.25);
  ExpectFisheye(vo::ReadCamera(
      Write("c.yaml",
            size + "model_type: KANNALA_BRANDT\nprojection_parameters:\n   k2: -0.0127\n   k3: 0.0114\n   k4: -0.0071\n"
                   "   k5: 0.0023\n   mu: 458.5\n   mv: 457.25\n   u0: 367.25\n   v0: 248.375\n")));
  const std::string mei = ErrorOf(Write("c.yaml", size + "model_type: MEI\nmirror_parameters:\n   xi: 1.9\n"));
  EXPECT_THAT(mei, HasSubstr("MEI"));
  EXPECT_EQ(std::count(mei.begin(), mei.end(), '\n'), 0) << mei;
  EXPECT_THAT(ErrorOf(Write("c.yaml", "%YAML:1.0\nimu: 1\ncam0_calib: \"cam0_mei.yaml\"\n")),
              HasSubstr("give the file that cam0_calib names"));
}

TEST_F(CameraFile, OfBasalt) {
  const std::string
      head = R"({"value0": {"T_imu_cam": [{"px": 0}], "intrinsics": [{"camera_type": )",
      tail = R"(}, {"camera_type": "ds", "intrinsics": {"xi": 0}}], "resolution": [[752, 480], [752, 480]]}})";
  ExpectFisheye(vo::ReadCamera(Write(
      "calib.json", head +
                        R"("kb4", "intrinsics": {"fx": 458.5, "fy": 457.25, "cx": 367.25, "cy": 248.375, "k1": -0.0127,
                             "k2": 0.0114, "k3": -0.0071, "k4": 0.0023})" +
                        tail)));
  ExpectRadtan(
      vo::ReadCamera(
          Write("calib.json",
                head + R"("pinhole", "intrinsics": {"fx": 458.5, "fy": 457.25, "cx": 367.25, "cy": 248.375})" + tail)),
      0);
  EXPECT_THAT(ErrorOf(Write("calib.json", head + R"("ds", "intrinsics": {"fx": 1, "xi": 0})" + tail)),
              HasSubstr("'ds'"));
}

// Messages as printed by `rostopic echo` and `ros2 topic echo`.
TEST_F(CameraFile, OfRosTopics) {
  for (const bool capitals : {true, false}) {
    const std::string k = capitals ? "K" : "k", d = capitals ? "D" : "d";
    const std::string text =
        "header:\n  seq: 1\n  frame_id: \"cam\"\nheight: 480\nwidth: 752\ndistortion_model: \"plumb_bob\"\n" + d +
        ": [-0.25, 0.07, 0.0001, 2e-05, 0.0]\n" + k +
        ": [458.5, 0.0, 367.25, 0.0, 457.25, 248.375, 0.0, 0.0, 1.0]\n---\n";
    ExpectRadtan(vo::ReadCamera(Write("info.yaml", text + text)), -0.25);
  }
}

// Messages without distortion, whose model may be unnamed. Binned and cropped images are refused: their calibration
// differs from the sensor's.
TEST_F(CameraFile, OfRosWithoutDistortionBinnedAndCut) {
  const std::string text =
      "height: 480\nwidth: 752\ndistortion_model: ''\nD: []\nK: [458.5, 0, 367.25, 0, 457.25, 248.375, 0, 0, 1]\n";
  ExpectRadtan(vo::ReadCamera(Write("info.yaml", text + "binning_x: 1\nroi: {x_offset: 0, y_offset: 0}\n")), 0);
  EXPECT_THAT(ErrorOf(Write("info.yaml", text + "binning_x: 2\n")), HasSubstr("info.yaml:6:12: the images are binned"));
  EXPECT_THAT(ErrorOf(Write("info.yaml", text + "roi: {x_offset: 0, y_offset: 8}\n")),
              HasSubstr("a region of the sensor"));
}

// Keys without a blank after the colon, as cv::FileStorage accepts. Settings for ORB-SLAM's rectification are refused:
// they describe other images.
TEST_F(CameraFile, OfOrbSlamAsItIsWritten) {
  const std::string text = "%YAML:1.0\nCamera.fx:458.5\nCamera.fy: 457.25\nCamera.cx: 367.25\nCamera.cy: 248.375\n",
                    size = "Camera.width:752\nCamera.height:480\n";
  ExpectRadtan(vo::ReadCamera(Write("o.yaml", text + size)), 0);
  EXPECT_EQ(ErrorOf(Write("o.yaml", text)),
            (folder_ / "o.yaml").string() + ": has no 'Camera.width' and 'Camera.height': add the size of the images");
  EXPECT_THAT(ErrorOf(Write("o.yaml", text + size + "LEFT.K: !!opencv-matrix\n   rows: 1\n   cols: 1\n   data:[1]\n")),
              HasSubstr("images that 'LEFT.K' rectifies"));
}

TEST_F(CameraFile, OfNoKnownKindIsOneSentence) {
  for (const auto& [name, text, words] : std::vector<std::tuple<std::string, std::string, std::string>>{
           {"ost.txt", "# oST version 5.0 parameters\n[image]\n\nwidth\n640\n", "no calibration of a kind"},
           {"k.txt", "458.5 457.25 367.25 248.375\n", "no calibration of a kind"},
           {"transforms.json", "{\"fl_x\": 458.5, \"cx\": 367.25, \"cy\": 248.375}", "no calibration of a kind"},
           {"k.yaml", "%YAML:1.0\nK: !!opencv-matrix\n   rows: 1\n   cols: 1\n   data: [1]\n",
            "no calibration of a kind"},
           {"c.xml", "<?xml version=\"1.0\"?><calibration><f>1</f></calibration>", "XML, but not of cv::FileStorage"},
           {"c.yaml",
            std::string("\xff\xfe"
                        "w\0",
                        4),
            "UTF-16"},
           {"cameras.bin", std::string("\1\0\0\0", 4), "no text"}}) {
    const std::string error = ErrorOf(Write(name, text));
    EXPECT_THAT(error, HasSubstr(words));
    EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 0) << error;
  }
  const std::string error = ErrorOf(Write("other.yaml", "name: x\nfocal: 3\nvalues: [1, 2]\n"));
  EXPECT_THAT(error, HasSubstr("is no calibration of a kind that is known here"));
  EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 0) << error;
}

// A readout time in another program's format: in our words, in those of VINS, and where nothing reads it.
TEST_F(CameraFile, ReadoutTimeInOtherFormats) {
  const auto file = [&](const std::string& rest) {
    return Write("readout.yaml",
                 "image_width: 640\nimage_height: 480\ncamera_matrix: [525, 0, 320, 0, 525, 240, 0, 0, 1]\n"
                 "distortion_coefficients: [0.1, 0, 0, 0]\n" +
                     rest);
  };
  const auto readout = [&](const std::string& rest) { return vo::ReadCamera(file(rest)).readout_s; };
  EXPECT_EQ(readout("# rolling_shutter: 3\n"), std::nullopt);
  EXPECT_EQ(readout("rolling_shutter: 0.03\n"), 0.03);
  EXPECT_EQ(readout("rolling_shutter: -26 ms\n"), -0.026);
  EXPECT_EQ(readout("rolling_shutter: 1  # flag\nrolling_shutter_tr: 0.033\n"), 0.033);
  EXPECT_EQ(readout("rolling_shutter: 0\nrolling_shutter_tr: 0.033\n"), 0);
  EXPECT_THAT(ErrorOf(file("rolling_shutter: 3 m\n")), HasSubstr("readout.yaml:5:18: 'rolling_shutter'"));
  EXPECT_THAT(ErrorOf(file("sensor:\n  rolling_shutter: 0.03\n")), HasSubstr("readout.yaml:6:3: 'rolling_shutter'"));
}

}  // namespace

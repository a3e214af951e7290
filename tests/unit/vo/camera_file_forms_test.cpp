// Calibration files in the forms that people and programs give them: each is read as it is meant, or refused in one
// sentence.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <vector>

#include "tests/temporary_folder.h"
#include "vo/geometry/camera_file.h"

namespace {

namespace fs = std::filesystem;
using testing::EndsWith;
using testing::HasSubstr;

struct Case {
  std::string name, text;
  std::string words = "";  // of the refusal; empty: read
};

class CameraFileForms : public testing::Test {
 protected:
  static std::string ErrorOf(const std::string& camera) {
    try {
      vo::CameraFrom(camera);
    } catch (const std::exception& error) {
      return error.what();
    }
    return "";
  }

  // Reads 458.5, 457.25, 367.25, 248.375 and k1 = `k1`, or refuses with the words in one line.
  void Expect(const std::vector<Case>& cases, double k1 = -0.25, vo::Lens lens = vo::Lens::radial_tangential) const {
    for (const Case& each : cases) {
      SCOPED_TRACE(each.name + ":\n" + each.text);
      const std::string error = ErrorOf(folder_.Write(each.name, each.text).string());
      EXPECT_EQ(std::ranges::count(error, '\n'), 0) << error;
      EXPECT_THAT(error, each.words.empty() ? testing::Matcher<std::string>("") : HasSubstr(each.words));
      if (!each.words.empty() || !error.empty()) continue;
      const vo::Camera c = vo::ReadCamera(folder_ / each.name);
      EXPECT_EQ(std::vector({c.fx, c.fy, c.cx, c.cy, c.k1}), std::vector({458.5, 457.25, 367.25, 248.375, k1}));
      EXPECT_EQ(std::vector({c.width, c.height}), std::vector({752, 480}));
      EXPECT_EQ(c.lens, lens);
    }
  }

  vobench_test::TemporaryFolder folder_;
};

const std::string kMatrix = "[458.5, 0, 367.25, 0, 457.25, 248.375, 0, 0, 1]", kLens = "[-0.25, 0.07, 0.0001, 2e-05]",
                  kSize = "image_width: 752\nimage_height: 480\n";

std::string Replaced(std::string text, const std::string& part, const std::string& by) {
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + by.size()))
    text.replace(at, part.size(), by);
  return text;
}

std::string Xml(const std::string& other = "") {
  return "<?xml version=\"1.0\"?>\n<opencv_storage>\n" + other +
         "<image_width>752</image_width>\n<image_height>480</image_height>\n"
         "<camera_matrix type_id=\"opencv-matrix\">\n  <rows>3</rows>\n  <cols>3</cols>\n  <dt>d</dt>\n  <data>\n"
         "    458.5 0. 367.25 0.\n    457.25 248.375 0. 0. 1.</data></camera_matrix>\n"
         "<distortion_coefficients type_id=\"opencv-matrix\">\n  <rows>1</rows>\n  <cols>4</cols>\n  <dt>d</dt>\n"
         "  <data>\n    -0.25 0.07 0.0001 2e-05</data></distortion_coefficients>\n</opencv_storage>\n";
}

TEST_F(CameraFileForms, XmlOfOpenCv) {
  const std::string matrix = "<_ type_id=\"opencv-matrix\"><rows>1</rows><cols>1</cols><dt>d</dt><data>\n0.</data></_>";
  Expect({{"crlf.xml", Replaced(Xml(), "\n", "\r\n")},
          {"no_indent.xml", Replaced(Xml(), "\n    ", "\n")},
          {"points.xml", Xml("<points>\n  7. 7. 8. 7.</points>\n<translation>0. 0. 0.</translation>\n")},
          {"title.xml", Xml("<calibration_date>\"11/11/11 - 11:11 am am\"</calibration_date>\n")},
          {"lists.xml", Xml("<rvecs>\n  " + matrix + "\n  " + matrix + "</rvecs><p><_>1. 1.</_><_>1. 1.</_></p>\n")},
          {"comment.xml",
           Replaced(Replaced(Xml("<!-- a <b> -->"), ">752", "><!-- px -->752"), "458.5", "<!-- fx\n0 cx -->458.5")},
          {"cut.xml", Xml("<!-- no end"), "cut off in a comment"}});
  Expect({{"empty.xml", Replaced(Replaced(Xml(), "<rows>1", "<rows>0"), "-0.25 0.07 0.0001 2e-05", "")}}, 0);
}

TEST_F(CameraFileForms, MatricesOfOpenCvAndRos) {
  const std::string k = "camera_matrix: ", d = "distortion_coefficients: ",
                    plain = kSize + k + kMatrix + "\n" + d + kLens;
  const std::string rows = "[[458.5, 0, 367.25], [0, 457.25, 248.375], [0, 0, 1]]";
  const auto matrix = [&](const std::string& numbers) { return kSize + k + numbers + "\n" + d + kLens; };
  const std::string bad = "must have the rows fx 0 cx, 0 fy cy, 0 0 1";
  Expect(
      {{"list.yml", plain},
       {"rows.yml", matrix(rows)},
       {"data_rows.yml", matrix("{rows: 3, cols: 3, data: " + rows + "}")},
       {"ros.yaml", plain + "\ndistortion_model: plumb_bob\n"},
       {"rows.yaml", matrix("{data: " + rows + "}") + "\ndistortion_model: plumb_bob\n"},
       {"small.yml",
        Replaced(Replaced(plain, "camera_matrix", "cameraMatrix"), "distortion_coefficients", "distCoeffs")},
       {"stereo.yml", Replaced(Replaced(plain, "camera_matrix", "M1"), "distortion_coefficients", "D1")},
       {"python.yml", Replaced(plain, "distortion_coefficients", "dist_coeff")},
       {"words.yml", matrix("[[a, b], [c, d]]"), "'camera_matrix': expected numbers, or rows of numbers"},
       {"transposed.yml", matrix("[458.5, 0, 0, 0, 457.25, 0, 367.25, 248.375, 1]"), bad},
       {"scaled.yml", matrix("[917, 0, 734.5, 0, 914.5, 496.75, 0, 0, 2]"), bad},
       {"k21.yaml", matrix("[458.5, 0, 367.25, 7, 457.25, 248.375, 0, 0, 1]") + "\ndistortion_model: plumb_bob\n", bad},
       {"omni.yml", plain + "\nxi: 1.2\n", "omni.yml:5:5: OpenCV's omnidirectional model"},
       {"sphere.yml", Replaced(plain, "camera_matrix", "M1") + "\ndistortion_model: double_sphere\n",
        "'distortion_model' is 'double_sphere'"},
       {"product.yml", plain + "\nmodel: D435\n"},
       {"model.yml", kSize + "model: fisheye\n" + k + kMatrix + "\n" + d + "[]", "there are 0 numbers"},
       {"flag.yml", kSize + "fisheye: true\n" + k + kMatrix + "\n" + d + "[]", "there are 0 numbers"},
       {"fisheye.yml", kSize + "fisheye_model: 1\n" + k + kMatrix + "\n" + d + "[]", "there are 0 numbers"},
       {"binned.yaml",
        "width: 752\nheight: 480\ndistortion_model: plumb_bob\nD: " + kLens + "\nK: " + kMatrix +
            "\nbinning_x: 2\nbinning_y: 2\n",
        "images are binned"}});
  Expect({{"rows0.yml", kSize + k + kMatrix + "\n" + d + "{rows: 0, cols: 0, data: []}"},
          {"rows1.yml", kSize + k + kMatrix + "\n" + d + "{rows: 0, cols: 1, data: []}"}},
         0);
}

TEST_F(CameraFileForms, TextOfColmapAndDso) {
  const std::string camera = "1 OPENCV 752 480 458.5 457.25 367.75 248.875 -0.25 0.07 1e-4 2e-5",
                    dso = "RadTan 458.5 457.25 367.25 248.375 -0.25 0.07 1e-4 2e-5\n", size = "752 480\n";
  const auto with = [&](const std::string& old, const std::string& now) {
    return "# head\n" + Replaced(camera, old, now);
  };
  Expect(
      {{"comment.txt", camera + " # front"},
       {"nan.txt", with("367.75", "nan"), "nan.txt:2:1: 'nan' is not a finite number"},
       {"nan_lens.txt", with("-0.25", "nan"), "nan_lens.txt:2:1: 'nan' is not a finite number"},
       {"inf.txt", with("458.5", "inf"), "'inf' is not a finite number"},
       {"size.txt", with("752", "752.0"), "size.txt:2:1: COLMAP's width and height must be whole numbers"},
       {"two.txt", camera + "\n\n" + camera, "two.txt:3:1: holds more than one camera"},
       {"model.txt", with("OPENCV", "FOV"), "model.txt:2:1: COLMAP's model FOV is not known"},
       {"plus.txt", Replaced(dso, "458.5", "+458.5") + size},
       {"ends.txt", Replaced(dso + size, "\n", " # end\n")},
       {"small.txt", Replaced(dso, "RadTan", "radtan") + size},
       {"inf_dso.txt", Replaced(dso, "0.07", "inf") + size, "inf_dso.txt:1:1: 'inf' is not a finite number"},
       {"no_size.txt", dso + "crop\n640 480\n", "no_size.txt:2:1: the line after the model's must be the width"},
       {"name.txt", Replaced(dso, "RadTan", "OpenCV") + size, "the model 'OpenCV' is not known here; known in DSO's"},
       {"nine.txt", "458.5 457.25 367.25 248.375 -0.25 0 0 0 1\n" + size, "there are 9 numbers"},
       {"fifth.txt", "Pinhole 458.5 457.25 367.25 248.375 0.93\n" + size, "the fifth number of DSO's Pinhole"}});
}

TEST_F(CameraFileForms, Kalibr) {
  const auto chain = [](const std::string& model, const std::string& lens, const std::string& other = "") {
    return "cam0:\n  cam_overlaps: &id001 [1]\n  camera_model: " + model +
           "\n  intrinsics: [458.5, 457.25, 367.25, 248.375]\n  resolution: [752, 480]\n  distortion_model: " + lens +
           other + "\ncam1:\n  cam_overlaps: *id001\n";
  };
  const std::string coefficients = "\n  distortion_coeffs: " + kLens;
  Expect(
      {{"alias.yaml", chain("pinhole", "radtan", coefficients)},
       {"omni.yaml", Replaced(chain("omni", "radtan", coefficients), "[458.5", "[1.9, 458.5"),
        "the camera model 'omni'"},
       {"fov.yaml", chain("pinhole", "fov", "\n  distortion_coeffs: [0.9]"), "calibrate a pinhole with a radtan"},
       {"none.yaml", chain("pinhole", "none", coefficients), "'distortion_coeffs' must be 0 where"},
       {"none.yaml", chain("pinhole", "equidistant", "\n  distortion_coeffs: []"), "there are 0 numbers"},
       {"fx.yaml", chain("pinhole", "radtan", coefficients + "\n  fx: 900"), "'fx' has 900 where the rest has 458.5"},
       {"both.yaml",
        chain("pinhole", "radtan", coefficients + "\n  distortion_coefficients: " + Replaced(kLens, "-0.25", "0.25")),
        "'distortion_coefficients' has 0.25 where the rest has -0.25"}});
  const std::string rolls = chain("pinhole", "radtan", coefficients + "\n  line_delay: 5e-05");
  EXPECT_NEAR(vo::ReadCamera(folder_.Write("rolls.yaml", rolls).string()).readout_s.value_or(0), 479 * 5e-5, 1e-12);
}

TEST_F(CameraFileForms, SlamPrograms) {
  const std::string
      projection = "Camera.fx: 458.5\nCamera.fy: 457.25\nCamera.cx: 367.25\nCamera.cy: 248.375\nCamera.k1: -0.25\n",
      rest = "Camera.k2: 0\nCamera.k3: 0\nCamera.k4: 0\n", size = "Camera.cols: 752\nCamera.rows: 480\n",
      fisheye = "Camera.model: \"fisheye\"\n" + projection + rest + size;
  const std::string
      head = R"({"T_imu_cam": [], "intrinsics": [{"camera_type": "kb4", "intrinsics": {"fx": 458.5, "fy": 457.25, )",
      numbers = R"("cx": 367.25, "cy": 248.375, "k1": -0.25, )", ks = R"("k2": 0, "k3": 0, "k4": 0)",
      tail = R"(}}], "resolution": [[752, 480]]})";
  Expect({{"o.yaml", fisheye},
          {"nested.yaml", "Camera:\n" + Replaced(fisheye, "Camera.", "  ")},
          {"basalt.json", R"({"value0": )" + head + numbers + ks + tail + "}"},
          {"no_value0.json", head + numbers + ks + tail}},
         -0.25, vo::Lens::fisheye);
  Expect(
      {{"o.yaml", "Camera.model: \"perspective\"\n" + projection + size},
       {"e.yaml", "Camera.model: \"equirectangular\"\n" + size,
        "e.yaml:1:15: 'Camera.model': 'equirectangular' is not"},
       {"k.yaml", "Camera.type: \"KannalaBrandt8\"\n" + projection + size, "add its Camera.k2, Camera.k3, Camera.k4"},
       {"t.yaml", "Camera.type: \"Fisheye\"\n" + projection + "Camera.k4: 1\n" + size, "'Fisheye' is not known"},
       {"k.json", head + numbers + R"("k2": 0)" + tail, "add its k3, k4"},
       {"stella.yaml",
        "Camera.model: \"perspective\"\n" + projection + size + "StereoRectifier:\n  K_left: [1, 0, 0]\n",
        "'StereoRectifier' rectifies"},
       {"nested.yaml",
        "Camera:\n  model: perspective\n" + Replaced(projection + size, "Camera.", "  ") +
            "StereoRectifier:\n  model: x\n",
        "'StereoRectifier' rectifies"},
       {"half.json", Replaced(head + numbers + ks + tail, "752", "752.5"), "'resolution' must have"},
       {"none.json", Replaced(head + numbers + ks + tail, "[[752, 480]]", "[]"), "'resolution' must have"}});
}

TEST_F(CameraFileForms, OtherPrograms) {
  const std::string unknown = "is no calibration of a kind that is known here";
  Expect({{"meshroom.json", R"({"intrinsics": [{"width": "752"}], "views": []})", unknown},
          {"open3d.json", R"({"width": 752, "height": 480, "intrinsic_matrix": [1, 0, 0]})", unknown},
          {"realsense.json", R"({"width":752,"height":480,"ppx":1,"ppy":1,"fx":458.5,"fy":457.25})", unknown},
          {"ost.ini", "# oST version 5.0 parameters\n\n[image]\n\nwidth\n752\n\n[left]\n", unknown},
          {"okvis.yaml", "%YAML:1.0\ncameras:\n  - {image_dimension: [752, 480]}\nimage_width: 752\n", "OKVIS"}});
}

// Keys beside a matrix that state the same otherwise, and parts of a camera_info that change the images.
TEST_F(CameraFileForms, KeysThatContradict) {
  const std::string opencv = kSize + "camera_matrix: " + kMatrix + "\ndist_coeffs: " + kLens + "\n",
                    words = " where the rest has ";
  const std::string ros = Replaced(opencv, "dist_coeffs", "distortion_coefficients") + "distortion_model: plumb_bob\n";
  std::vector<Case> cases = {
      {"same.yaml", opencv + "fx: 458.5\nk1: -0.25\nk3: 0\nwidth: 752\nimage_size: [752, 480]\nfocal_length: 900\n"},
      {"tagged.yaml",
       Replaced(opencv, ": [458", ": !!opencv-matrix\n  rows: 3\n  cols: 3\n  data: [458") + "fx: 458.5\n"},
      {"second.yaml", opencv + "M1: " + kMatrix, "'M1' states what 'camera_matrix' does"},
      {"k.yaml", opencv + "K: " + kMatrix, "'K' states what 'camera_matrix' does"},
      {"d.yaml", opencv + "D: " + kLens, "'D' states what 'dist_coeffs' does"},
      {"lens.yaml", opencv + "lens: omni", "'lens' is 'omni'"},
      {"name.yaml", opencv + "model: Basler"},
      {"ros.yaml", ros + "fx: 900", "'fx' has 900 where the rest has 458.5"},
      {"roi.yaml", ros + "roi: {x_offset: 0, y_offset: 0, width: 376, height: 240}", "region of the sensor"},
      {"full.yaml", ros + "roi: {x_offset: 0, y_offset: 0, width: 752, height: 480}"},
      {"empty.yaml", Replaced(Replaced(ros, kLens, "[]"), "plumb_bob", "equidistant"), "k1 ... k4, which are missing"},
      {"count.yaml", Replaced(ros, kLens, "{rows: 1, cols: 5, data: " + kLens + "}"),
       "expected 5 numbers, 1 x 5, not 4"}};
  for (const char* key : {"fx: 900", "cy: 200", "k1: 0.3", "k4: 0.1", "p1: 0.5", "skew: 0.3", "width: 1504",
                          "image_size: [1504, 960]", "resolution: [1504, 960]", "intrinsics: [900, 900, 376, 240]"})
    cases.push_back({"other.yaml", opencv + key, words});
  Expect(cases);
  EXPECT_THAT(ErrorOf(folder_.Write("place.yaml", opencv + "fx: 900").string()), HasSubstr("place.yaml:5:5: "));
}

TEST_F(CameraFileForms, OtherProgramsByName) {
  Expect(
      {{"calib.txt", "P0: 718 0 607 0 0 718 185 0 0 0 1 0\n", "KITTI's"},
       {"calib_cam_to_cam.txt", "calib_time: 09-Jan-2012 13:57:47\nK_00: 984 0 690 0 980 233 0 0 1\n", "KITTI's"},
       {"transforms.json", R"({"fl_x": 458.5, "fl_y": 457, "cx": 367, "cy": 248, "w": 752, "h": 480})", "nerfstudio's"},
       {"blender.json", R"({"camera_angle_x": 0.69, "frames": []})", "NeRF's"},
       {"open3d.json", R"({"width": 752, "height": 480, "intrinsic_matrix": [458, 0, 0, 0, 457, 0, 367, 248, 1]})",
        "Open3D's"},
       {"ost.ini", "[image]\n\nwidth\n640\n\nheight\n480\n", "the ini file of ROS"}});
}

TEST_F(CameraFileForms, NumbersThatNoCameraHas) {
  const auto own = [](const std::string& fx, const std::string& cx) {
    return "width: 752\nheight: 480\nfx: " + fx + "\nfy: 457.25\ncx: " + cx +
           "\ncy: 248.375\ndistortion: {k1: -0.25}\n";
  };
  Expect(
      {{"c.yaml", own("458.5", "367.25")},
       {"c.yaml", own("0.61", "0.5"), "a focal length of 0.61 px does not fit images 752 px wide: expected 75.2 px to"},
       {"c.yaml", own("458.5e6", "367.25"), "a focal length of 4.585e+08 px"},
       {"c.yaml", own("458.5", "36725"), "a principal point at 36725 px does not fit"},
       {"c.txt", "Pinhole 0.61 0.95 1 0.5 0\n752 480\n", "a focal length of 0.61 px"}});
}

TEST_F(CameraFileForms, NamesOfNoFile) {
  EXPECT_THAT(ErrorOf(folder_.path().string()), EndsWith("is a folder: give the calibration file in it"));
  EXPECT_EQ(ErrorOf("nowhere.yaml"), "there is no file 'nowhere.yaml'");
  EXPECT_EQ(ErrorOf("no/where"), "there is no file 'no/where'");
  EXPECT_THAT(ErrorOf(""), HasSubstr("unknown camera preset ''"));
  const fs::path here = fs::current_path();
  fs::create_directory(folder_ / "icl");
  fs::current_path(folder_.path());
  EXPECT_EQ(ErrorOf("icl"), "");  // the preset, not the folder
  fs::current_path(here);
}

}  // namespace

// Calibration files of other people's systems, and entries of systems.yaml.
#include <gmock/gmock.h>

#include <filesystem>
#include <map>
#include <sstream>

#include "source_dir.h"
#include "tests/unit/bench/campaign/folder.h"
#include "tools/base/settings/problem.h"
#include "tools/bench/campaign/calibration.h"
#include "tools/bench/campaign/external_system.h"
#include "tools/bench/campaign/slurm.h"

namespace vobench::campaign {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Calibration Plain() { return {640, 480, 525.25, 524.5, 319.5, 239.25, 0, 0, 0, 0, 0, 0, false, 30}; }
Calibration Distorted() {
  Calibration c = Plain();
  c.k1 = 0.1, c.k2 = -0.2, c.p1 = 0.001, c.p2 = -0.002;
  return c;
}
Calibration Fisheye() {
  Calibration c = Plain();
  c.fisheye = true;
  c.k1 = 0.01, c.k2 = -0.02, c.k3 = 0.003, c.k4 = -0.0004;
  return c;
}

void ExpectSame(const Calibration& a, const Calibration& b) {
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  EXPECT_EQ(a.fisheye, b.fisheye);
  for (const auto member : {&Calibration::fx, &Calibration::fy, &Calibration::cx, &Calibration::cy, &Calibration::k1,
                            &Calibration::k2, &Calibration::p1, &Calibration::p2, &Calibration::k3, &Calibration::k4}) {
    EXPECT_NEAR(a.*member, b.*member, 1e-12 * 640);
  }
}

// Minimal readers of the formats that WriteCalibration writes.
std::map<std::string, std::string> KeysAndValues(const std::string& text) {
  std::map<std::string, std::string> values;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    const std::size_t colon = line.find(": ");
    if (colon != std::string::npos) values[line.substr(0, colon)] = line.substr(colon + 2);
  }
  return values;
}

Calibration FromKeys(const std::string& text, bool svo, const std::string& camera) {
  const std::map<std::string, std::string> file = KeysAndValues(text);
  const auto number = [&](const std::string& key) { return file.contains(key) ? std::stod(file.at(key)) : 0; };
  const std::string size = svo ? "cam_" : "Camera.";
  Calibration c;
  c.fisheye = !svo && file.at("Camera.type") == "\"KannalaBrandt8\"";
  c.width = static_cast<int>(number(size + "width"));
  c.height = static_cast<int>(number(size + "height"));
  c.fx = number(camera + "fx"), c.fy = number(camera + "fy"), c.cx = number(camera + "cx"),
  c.cy = number(camera + "cy");
  c.k1 = number(camera + (svo ? "d0" : "k1")), c.k2 = number(camera + (svo ? "d1" : "k2"));
  c.p1 = number(camera + (svo ? "d2" : "p1")), c.p2 = number(camera + (svo ? "d3" : "p2"));
  c.k3 = number(camera + "k3"), c.k4 = number(camera + "k4");
  return c;
}

Calibration FromLines(const std::string& text, bool dso) {
  std::istringstream stream(text);
  std::string line, model;
  std::getline(stream, line);
  std::istringstream first(line);
  if (dso) first >> model;
  std::vector<double> n;
  for (double value = 0; first >> value;) n.push_back(value);
  Calibration c;
  if (!(stream >> c.width >> c.height) || (n.size() != 5 && n.size() != 8)) {
    ADD_FAILURE() << line;
    return c;
  }
  const double offset = dso || n.size() == 5 ? 0.5 : 0;
  c.fx = n[0] * c.width, c.fy = n[1] * c.height;
  c.cx = n[2] * c.width - offset, c.cy = n[3] * c.height - offset;
  c.fisheye = model == "EquiDistant";
  if (n.size() == 8) {
    c.k1 = n[4], c.k2 = n[5];
    (c.fisheye ? c.k3 : c.p1) = n[6];
    (c.fisheye ? c.k4 : c.p2) = n[7];
  }
  return c;
}

Calibration ReadCalibration(const std::string& text, CalibrationFormat format) {
  using F = CalibrationFormat;
  if (format == F::dso || format == F::lsd_slam) return FromLines(text, format == F::dso);
  if (format == F::svo) return FromKeys(text, true, "cam_");
  return FromKeys(text, false, format == F::orb_slam3 ? "Camera1." : "Camera.");
}

TEST(Calibration, IsReadBackAsItWasWritten) {
  using F = CalibrationFormat;
  for (const F format : {F::orb_slam2, F::orb_slam3, F::dso, F::svo, F::lsd_slam}) {
    SCOPED_TRACE(Name(format));
    ExpectSame(ReadCalibration(WriteCalibration(Plain(), format), format), Plain());
    ExpectSame(ReadCalibration(WriteCalibration(Distorted(), format), format), Distorted());
    Calibration k3 = Distorted();
    k3.k3 = 0.05;
    if (format == F::orb_slam2 || format == F::orb_slam3) {
      ExpectSame(ReadCalibration(WriteCalibration(k3, format), format), k3);
    } else {
      EXPECT_THROW(WriteCalibration(k3, format), std::invalid_argument);
    }
    if (format == F::orb_slam3 || format == F::dso) {
      ExpectSame(ReadCalibration(WriteCalibration(Fisheye(), format), format), Fisheye());
    } else {
      EXPECT_THROW(WriteCalibration(Fisheye(), format), std::invalid_argument);
    }
  }
}

// Worked by hand after each system's documentation: writer and reader here could share a mistake.
TEST(Calibration, DocumentedFormats) {
  Calibration c = Plain();
  c.width = 640, c.height = 400, c.fx = 320, c.fy = 300, c.cx = 319.5, c.cy = 199.5;
  EXPECT_EQ(WriteCalibration(c, CalibrationFormat::dso), "Pinhole 0.5 0.75 0.5 0.5 0\n640 400\nnone\n640 400\n")
      << "K(0,2) = width * cx - 0.5";
  EXPECT_EQ(WriteCalibration(c, CalibrationFormat::lsd_slam), "0.5 0.75 0.5 0.5 0\n640 400\nnone\n640 400\n");
  c.k1 = 0.25, c.p2 = -0.5, c.cx = 320, c.cy = 200;
  EXPECT_EQ(WriteCalibration(c, CalibrationFormat::lsd_slam),
            "0.5 0.75 0.5 0.5 0.25 0 0 -0.5\n640 400\ncrop\n640 400\n")
      << "its OpenCV model has no half pixel";
  EXPECT_THAT(WriteCalibration(c, CalibrationFormat::svo),
              HasSubstr("cam_model: Pinhole\ncam_width: 640\ncam_height: 400\ncam_fx: 320.0\n"));
  EXPECT_THAT(WriteCalibration(c, CalibrationFormat::orb_slam2), HasSubstr("\nCamera.fx: 320.0\n"));
  const std::string orb3 = WriteCalibration(Fisheye(), CalibrationFormat::orb_slam3);
  EXPECT_THAT(orb3, HasSubstr("%YAML:1.0\n"));
  EXPECT_THAT(orb3, HasSubstr("File.version: \"1.0\"\nCamera.type: \"KannalaBrandt8\"\nCamera1.fx: 525.25\n"));
  EXPECT_THAT(orb3, HasSubstr("\nCamera.fps: 30\n")) << "a whole number";
}

TEST(ExternalSystem, TheShippedEntriesAreGood) {
  const auto systems = ReadExternalSystems(std::filesystem::path(VOBENCH_SOURCE_DIR) / "scenes/systems.yaml");
  std::vector<std::string> names;
  for (const ExternalSystem& system : systems) {
    names.push_back(system.name);
    EXPECT_THAT(system.command, HasSubstr("{calibration}"));
    ExpectSame(ReadCalibration(WriteCalibration(Plain(), system.calibration), system.calibration), Plain());
  }
  EXPECT_THAT(names, ElementsAre("orb_slam2", "orb_slam3", "dso", "svo", "lsd_slam"));
}

TEST(ExternalSystem, PlaceholdersAreFilledInQuoted) {
  EXPECT_EQ(FillIn("{root}/x {sequence} ${HOME} { echo; } {other} {seed}",
                   {{"root", "/a b"}, {"sequence", "it's"}, {"seed", "3"}}),
            "'/a b'/x 'it'\\''s' ${HOME} { echo; } {other} '3'");
}

TEST(ExternalSystem, EveryProblemIsListed) {
  const Folder here;
  try {
    ReadExternalSystems(here.Write("s.yaml", R"(systems:
  - {name: a, command: "x {calibration} {sequenze}", timeout: 0 s}
  - {name: a, layout: tom, variables: {v: [1]}}
)"));
    FAIL() << "nothing was thrown";
  } catch (const settings::Error& error) {
    for (const char* expected :
         {"{calibration} needs the key 'calibration'", "{sequenze} stands for nothing; there are {calibration}",
          "'systems.0.timeout'", "there is a system 'a' already", "missing key 'systems.1.command'",
          "'systems.1.layout': 'tom' is not known", "'systems.1.variables.v'"}) {
      EXPECT_THAT(error.what(), HasSubstr(expected));
    }
  }
}

TEST(Slurm, TasksAreDealtOutInOrderAndReadBack) {
  const Folder here;
  EXPECT_THAT(ArrayLines({1, 2, 5, 7, 9}, 2), ElementsAre("1 2", "5 7", "9"));
  EXPECT_EQ(ArrayLines(std::vector<std::int64_t>(5000, 1), 2).size(), 1000u) << "no more than an array may have";
  const auto list = here.Write("list", "1 2\n5 7\n9\n");
  EXPECT_THAT(ReadArrayLine(list, 1), ElementsAre(5, 7));
  EXPECT_THAT(ReadArrayLine(list, 2), ElementsAre(9));
  EXPECT_THROW(ReadArrayLine(list, 3), std::invalid_argument);
  EXPECT_THROW(ReadArrayLine(here.Write("bad", "1 x\n"), 0), std::invalid_argument);
}

TEST(Slurm, Script) {
  const std::string script = BatchScript({"long", "1:00", 1 << 30, 10}, "name", 3, "/out", "do --part");
  for (const char* expected : {"#!/bin/sh\n", "--job-name=name\n", "--array=0-2\n", "--partition=long\n",
                               "--time=1:00\n", "--mem=1280M\n", "exec do --part \"$SLURM_ARRAY_TASK_ID\"\n"}) {
    EXPECT_THAT(script, HasSubstr(expected));
  }
  EXPECT_THAT(BatchScript({}, "name", 1, "/out", "do"), testing::Not(HasSubstr("--partition")));
}

}  // namespace
}  // namespace vobench::campaign

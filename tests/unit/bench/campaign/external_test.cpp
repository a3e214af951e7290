// Calibration files of other people's systems, and entries of systems.yaml.
#include <gmock/gmock.h>

#include <filesystem>

#include "tests/unit/bench/campaign/folder.h"
#include "tools/base/settings/problem.h"
#include "tools/bench/campaign/calibration.h"
#include "tools/bench/campaign/external_system.h"
#include "tools/bench/campaign/slurm.h"

namespace campaign {
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
TEST(Calibration, SaysWhatEachSystemDocuments) {
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

TEST(Calibration, WhatIsNoneIsRefused) {
  EXPECT_THROW(ReadCalibration("", CalibrationFormat::dso), std::invalid_argument);
  EXPECT_THROW(ReadCalibration("0.5 0.5 0.5\n1 1\n", CalibrationFormat::lsd_slam), std::invalid_argument);
  EXPECT_THROW(ReadCalibration("cam_width: x\n", CalibrationFormat::svo), std::invalid_argument);
  EXPECT_THROW(ReadCalibration("what\n", CalibrationFormat::orb_slam2), std::invalid_argument);
}

TEST(ExternalSystem, TheShippedEntriesAreGood) {
  const auto systems = ReadExternalSystems(std::filesystem::path(VOBENCH_SOURCE_DIR) / "scenes/systems.yaml");
  std::vector<std::string> names;
  for (const ExternalSystem& system : systems) {
    names.push_back(system.name);
    EXPECT_THAT(system.command, HasSubstr("{calibration}"));
    EXPECT_NO_THROW(ReadCalibration(WriteCalibration(Plain(), system.calibration), system.calibration));
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

TEST(Slurm, TheScriptSaysWhatIsAsked) {
  const std::string script = BatchScript({"long", "1:00", 1 << 30, 10}, "name", 3, "/out", "do --part");
  for (const char* expected : {"#!/bin/sh\n", "--job-name=name\n", "--array=0-2\n", "--partition=long\n",
                               "--time=1:00\n", "--mem=1280M\n", "exec do --part \"$SLURM_ARRAY_TASK_ID\"\n"}) {
    EXPECT_THAT(script, HasSubstr(expected));
  }
  EXPECT_THAT(BatchScript({}, "name", 1, "/out", "do"), testing::Not(HasSubstr("--partition")));
}

}  // namespace
}  // namespace campaign

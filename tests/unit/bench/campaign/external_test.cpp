// Entries of systems.yaml, and job arrays of Slurm.
#include <gmock/gmock.h>

#include <filesystem>

#include "source_dir.h"
#include "tests/unit/bench/campaign/folder.h"
#include "tools/base/settings/problem.h"
#include "tools/bench/campaign/external_system.h"
#include "tools/bench/campaign/slurm.h"

namespace vobench::campaign {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(ExternalSystem, TheShippedEntriesAreGood) {
  const auto systems = ReadExternalSystems(std::filesystem::path(VOBENCH_SOURCE_DIR) / "scenes/systems.yaml");
  std::vector<std::string> names;
  for (const ExternalSystem& system : systems) {
    names.push_back(system.name);
    if (system.sensors.metric()) {
      EXPECT_EQ(system.layout, SequenceLayout::euroc) << system.name;
      EXPECT_EQ(system.command.find("{configs}") == std::string::npos, system.name == "stereo_flow") << system.name;
      EXPECT_NE(system.align, evaluation::Alignment::sim3) << system.name;
    } else {
      EXPECT_EQ(system.command.find("{calibration}") == std::string::npos, system.name == "flow");
    }
  }
  EXPECT_THAT(names, ElementsAre("flow", "orb_slam2", "orb_slam3", "dso", "svo", "lsd_slam", "stereo_flow",
                                 "orb_slam3_stereo", "orb_slam3_stereo_imu", "openvins", "vins_fusion", "basalt"));
}

TEST(ExternalSystem, PlaceholdersAreFilledInQuoted) {
  EXPECT_EQ(FillIn("{root}/x {sequence} ${HOME} { echo; } {other} {seed}",
                   {{"root", "/a b"}, {"sequence", "it's"}, {"seed", "3"}}),
            "'/a b'/x 'it'\\''s' ${HOME} { echo; } {other} '3'");
}

TEST(ExternalSystem, AScriptThatIsNotThereIsSaid) {
  const Folder here;
  const std::string folder = here.Write("there.py", "").parent_path().string();
  const auto problem = [&](const std::string& command) {
    ExternalSystem system;
    system.command = command;
    system.variables = {{"here", folder}};
    return StartProblem(system);
  };
  for (const std::string script : {"{here}/gone.py", "/nowhere/gone", "./there.py"})
    EXPECT_EQ(problem("/bin/sh " + script + " {sequence}"), "'" + script + "', which the command names, is not there");
  EXPECT_EQ(problem("X=1 python3 {here}/gone.py"), "'{here}/gone.py', which the command names, is not there");
  for (const char* good : {"/bin/sh {here}/there.py {here}/gone.txt", "/bin/sh -c ./gone.sh", "cd /tmp && sh ./gone.sh",
                           "/bin/sh {trajectory}/x.sh", "/bin/sh x", "/bin/echo {here}/gone.py"})
    EXPECT_EQ(problem(good), "") << good;
}

TEST(ExternalSystem, EveryProblemIsListed) {
  const Folder here;
  try {
    ReadExternalSystems(here.Write("s.yaml", R"(systems:
  - {name: a, command: "x {calibration} {sequenze}", timeout: 0 s}
  - {name: a, layout: tom, variables: {v: [1]}}
  - {name: b, sensors: stereo, command: "x {configs}", align: yaw, poses_of: imu}
  - {name: c, sensors: stereo_imu, layout: euroc, images: rectified, command: "x", align: sim3}
  - {name: d, command: "x", align: se3}
)"));
    FAIL() << "nothing was thrown";
  } catch (const settings::Error& error) {
    for (const char* expected :
         {"{calibration} needs the key 'calibration'", "{sequenze} stands for nothing; there are {calibration}",
          "'systems.0.timeout'", "there is a system 'a' already", "missing key 'systems.1.command'",
          "'systems.1.layout': 'tom' is not known",
          "s.yaml:4:24: 'sensors': more than the pictures of one camera needs 'layout: euroc'",
          "{configs} needs the key 'configs'", "'align': yaw needs an IMU", "'poses_of': it takes no IMU",
          "s.yaml:5:24: 'sensors': more than", "'systems.3.align': 'sim3' is not known",
          "s.yaml:6:36: 'align': of one camera", "'systems.1.variables.v'"}) {
      EXPECT_THAT(error.what(), HasSubstr(expected));
    }
  }
}

TEST(ExternalSystem, AllKeysAreNamedInOrder) {
  const Folder here;
  try {
    ReadExternalSystems(here.Write("s.yaml", "systems: [{name: a, command: x, xyzzyplugh: 1}]\n"));
    FAIL() << "nothing was thrown";
  } catch (const settings::Error& error) {
    const std::string said = error.what();
    std::size_t last = said.find("known: ");
    ASSERT_NE(last, std::string::npos) << said;
    for (const char* key : {"accept_exit", "align", "calibration", "command", "configs", "files", "images", "layout",
                            "name", "poses_of", "sensors", "threads", "timeout", "trajectory", "variables", "writes"}) {
      const std::size_t at = said.find(key, last);
      ASSERT_NE(at, std::string::npos) << key << " is not behind the one before: " << said;
      last = at;
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
  CampaignOptions options;
  options.partition = "long";
  options.time = "1:00";
  options.memory_bytes = 1 << 30;
  const std::string script = BatchScript(options, "name", 3, "/out", "do --part");
  for (const char* expected : {"#!/bin/sh\n", "--job-name=name\n", "--array=0-2\n", "--partition=long\n",
                               "--time=1:00\n", "--mem=1280M\n", "exec do --part \"$SLURM_ARRAY_TASK_ID\"\n"}) {
    EXPECT_THAT(script, HasSubstr(expected));
  }
  EXPECT_THAT(BatchScript({}, "name", 1, "/out", "do"), testing::Not(HasSubstr("--partition")));
}

}  // namespace
}  // namespace vobench::campaign

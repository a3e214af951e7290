// Messages for errors of the user: what is wrong, where, and the remedy. The table has those without hardware faults.
#include <gmock/gmock.h>

#include <filesystem>

#include "tests/system/program.h"

namespace vobench::system_test {
namespace {
namespace fs = std::filesystem;
using Words = std::vector<std::string>;

struct Message {
  std::string source;  // file of the message
  Words arguments;     // TINY and POINTS stand for the two small scenarios
  Words says;          // all of these: error, place, remedy
};

// Run in a folder with the files of SpoiltFiles().
const std::vector<Message>& Messages() {
  static const std::vector<Message> all = {
      // Settings: file, line and column, or the --set option; nearest key, range or choice.
      {"tools/base/settings/settings.cpp", {"check", "broken.yaml"}, {"broken.yaml:2:1", "not valid YAML"}},
      {"tools/base/settings/settings.cpp",
       {"check", "nowhere.yaml"},
       {"nowhere.yaml", "cannot be read", "No such file"}},
      {"tools/base/settings/settings.cpp",
       {"check", "TINY", "--set", "camera.width=3 s"},
       {"--set camera.width", "'3 s'", "whole number"}},
      {"tools/base/settings/settings.cpp",
       {"check", "TINY", "--set", "camera.widht=3"},
       {"--set camera.widht", "did you mean 'width'"}},
      {"tools/base/settings/settings.cpp",
       {"check", "TINY", "--set", "prior.start=here"},
       {"--set prior.start", "'here'", "known: origin, truth"}},
      {"tools/base/settings/settings.cpp",
       {"track", "pictures", "-o", "o", "--camera", "half.yaml"},
       {"half.yaml", "missing key 'height'", "missing key 'cy'"}},
      // Scenario, motion, world, sensor.
      {"sim/motion/trajectory.cpp",
       {"check", "TINY", "--set",
        "world.objects=[{file: room/parcel.obj, trajectory: {type: scripted, keys: [{time: 0 s, position: [0, 0, 0], "
        "orientation: [0, 0, 0, 1]}, {time: 0.1 s, position: [0, 0, 1], orientation: [0, 0, 0, 1]}]}}]"},
       {"world.objects", "0.1"}},
      {"sim/motion/path.cpp",
       {"check", "TINY", "--set",
        "trajectory={type: half_sphere, start: {position: [2, 1.4, 2], look_at: [2, 1, 1]}, center: [2, 1, 2], sweep: "
        "90 deg, period: 5 s, rise: 60 deg, rise_period: 8 s}"},
       {"--set trajectory", "pivot is straight above or below"}},
      {"sim/motion/recorded.cpp",
       {"check", "TINY", "--set", "trajectory={type: recorded, file: FOLDER/nan.txt}"},
       {"nan.txt:2", "nan"}},
      {"sim/motion/sampled.cpp",
       {"check", "TINY", "--set",
        "trajectory={type: sampled, start: {position: [2, 1.4, 3], look_at: [2, 1, 1]}, position_noise: 0.5, "
        "orientation_noise: 0.1, walls: {low: [0, 0, 0], high: [1, 3, 4]}}"},
       {"start.position = 2", "within the walls"}},
      {"sim/sensor/camera.cpp",
       {"check", "TINY", "--set", "camera.distortion.k1=-3"},
       {"--set camera.distortion.k1", "folds over inside the image"}},
      {"sim/sensor/sensor.cpp",
       {"render", "TINY", "-o", "o", "--set", "sensor.jpeg_quality=300"},
       {"--set sensor.jpeg_quality", "'300'", "0 ... 100"}},
      {"sim/sensor/exposure.cpp",
       {"check", "TINY", "--set", "sensor.auto_exposure={on: true, shortest: 30 ms, longest: 1 ms}"},
       {"auto_exposure.longest = 0.001", "not be below shortest"}},
      {"sim/sensor/vignetting.cpp",
       {"check", "TINY", "--set", "sensor.optics.vignetting_2=-3"},
       {"vignetting: the factor of pixel (0, 0)", "below 0", "nearer to 0"}},
      {"sim/simulator.cpp", {"render", "POINTS", "-o", "o"}, {"a world of points has no images", "vobench run"}},
      {"sim/world/scene.cpp",
       {"check", "TINY", "--set", "world.meshes=[{file: nothere.obj}]"},
       {"nothere.obj", "no such file"}},
      {"sim/world/mesh_loader.cpp",
       {"check", "TINY", "--set", "world.meshes=[{file: FOLDER/broken.obj}]"},
       {"broken.obj", "a face names vertex 2 of 1"}},
      {"sim/world/image_file.cpp",
       {"check", "TINY", "--set", "world.meshes=[{file: FOLDER/cut.png.obj}]"},
       {"cut.png", "truncated PNG: the end chunk is missing"}},
      {"sim/world/image_file.cpp",
       {"check", "TINY", "--set", "world.meshes=[{file: FOLDER/sum.png.obj}]"},
       {"sum.png", "damaged PNG: wrong checksum in the chunk at byte 8"}},
      {"sim/world/image_file.cpp",
       {"check", "TINY", "--set", "world.meshes=[{file: FOLDER/mark.jpg.obj}]"},
       {"mark.jpg", "damaged JPEG: no marker at byte"}},
      {"sim/world/image_file.cpp",
       {"check", "TINY", "--set", "world.meshes=[{file: FOLDER/chunk.png.obj}]"},
       {"chunk.png", "truncated PNG: a chunk is cut off"}},
      {"sim/world/sky.cpp",
       {"check", "TINY", "--set", "world.lights=[{type: sky, file: none.hdr}]"},
       {"none.hdr", "cannot be opened"}},
      {"sim/world/sky.cpp",
       {"check", "TINY", "--set", "world.lights=[{type: sky, file: FOLDER/one.txt}]"},
       {"one.txt", "not a picture that is read here"}},
      {"sim/scenario/world_reader.cpp",
       {"check", "TINY", "--set", "world.lights=[{type: sky, file: a.hdr, radiance: [1, 1, 1]}]"},
       {"a sky has either 'radiance', or 'zenith', 'horizon' and 'ground', or a 'file'"}},
      {"sim/scenario/world_reader.cpp",
       {"check", "TINY", "--set",
        "world.lights=[{type: rectangle, corner: [0, 2, 0], side_u: [1, 0, 0], side_v: [2, 0, 0], radiance: [1, 1, "
        "1]}]"},
       {"the rectangle has no area"}},
      {"sim/scenario/world_reader.cpp",
       {"check", "TINY", "--set", "world.lights=[{type: sky, radiance: [1, 1, 1], strength: 2}]"},
       {"only a sky from a file has it"}},
      {"sim/scenario/world_reader.cpp",
       {"check", "TINY", "--set", "world.lights=[{type: sky, radiance: [1, 1, 1]}, {type: sky, radiance: [1, 1, 1]}]"},
       {"there is a sky already: a world has one at most"}},
      {"sim/scenario/motion_reader.cpp",
       {"check", "TINY", "--set",
        "trajectory={type: sampled, start: {position: [2, 1.4, 3], look_at: [2, 1, 1]}, position_noise: 0.5, "
        "orientation_noise: 0.1, walls: {low: [0, 0, 0], high: [4, 3, 0.1]}}"},
       {"walls.high = 0.1", "two margins above low"}},
      {"sim/world/light.cpp",
       {"render", "TINY", "-o", "o", "--set", "render.light=baked", "--set", "world.lights=FLICKERS"},
       {"world.lights: lamps with 40 different flickers; at most"}},
      {"sim/points/point_world.cpp",
       {"run", "POINTS", "--set", "world.points.count=0"},
       {"--set world.points.count", "'0'", "1 ... 1000000"}},
      {"sim/light/bake.cpp",
       {"check", "TINY", "--set", "render.light=baked", "--set", "render.bake.spacing=0.01 mm"},
       {"--set render.bake.spacing", "not be above spacing"}},
      {"sim/render/ray_tracer.cpp",
       {"check", "TINY", "--set", "render.rays_per_time_sample=0"},
       {"rays_per_time_sample", "0"}},
      {"sim/sequence/content.cpp",
       {"render", "TINY", "-o", "o", "--format", "icl", "--set", "time.rate=24"},
       {"time.rate = 24 Hz", "must be 30 Hz"}},
      {"sim/sequence/writer.cpp", {"render", "TINY", "-o", "taken", "--frames", "0:2"}, {"taken", "is there"}},
      // Sequences, cameras.
      {"vo/sequence/reader.cpp", {"track", "nowhere", "-o", "o"}, {"nowhere", "no such folder"}},
      {"vo/sequence/reader.cpp", {"track", "empty", "-o", "o"}, {"empty/rgb.txt", "docs/sequence_format.md"}},
      {"vo/sequence/reader.cpp",
       {"track", "lists", "-o", "o", "--camera", "icl"},
       {"lists/rgb.txt:2", "does not increase over line 1", "rgb.txt:3: expected 'timestamp filename'"}},
      {"vo/sequence/reader.cpp",
       {"track", "pictures", "-o", "o", "--camera", "icl"},
       {"pictures/a.png", "not a picture that is read here"}},
      {"vo/sequence/reader.cpp",
       {"track", "nothing", "-o", "o", "--camera", "icl"},
       {"nothing/a.png", "cannot be read, or is empty"}},
      {"vo/sequence/reader.cpp",
       {"track", "floats", "-o", "o", "--camera", "icl"},
       {"floats/a.png", "expected an image of 8 or 16 bits"}},
      {"vo/geometry/camera.cpp",
       {"track", "pictures", "-o", "o", "--camera", "freiburg9"},
       {"'freiburg9'", "freiburg1, freiburg2, freiburg3 or icl, or a camera file that exists"}},
      {"vo/geometry/camera_file.cpp",
       {"track", "pictures", "-o", "o", "--camera", "nowhere.yaml"},
       {"there is no file 'nowhere.yaml'"}},
      {"vo/geometry/camera_file.cpp",
       {"track", "pictures", "-o", "o", "--camera", "pictures"},
       {"pictures: is a folder", "give the calibration file in it"}},
      {"vo/geometry/camera_file.cpp",
       {"track", "pictures", "-o", "o", "--camera", "opencv.xml"},
       {"opencv.xml:4:14", "'image_width': '0' must be positive",
        "'camera_matrix': expected a list of numbers, not '5'"}},
      {"vo/geometry/camera_file.cpp",
       {"track", "pictures", "-o", "o", "--camera", "none.xml"},
       {"none.xml:5:46", "'camera_matrix.data': '.Nan' is not a finite number"}},
      {"vo/geometry/camera_file.cpp",
       {"track", "pictures", "-o", "o", "--camera", "opencv.yaml"},
       {"opencv.yaml:3:14", "'image_width': '0' must be positive",
        "'camera_matrix': expected a list of numbers, not '5'", "'distortion_coefficients' must be a matrix"}},
      {"vo/geometry/camera_file.cpp",
       {"track", "pictures", "-o", "o", "--camera", "none.yaml"},
       {"none.yaml:9:12", "'camera_matrix.data': '.Nan' is not a finite number"}},
      {"vo/filter_adapter.cpp",
       {"run", "POINTS", "--set", "odometry.motion.position_noise=-1"},
       {"odometry.motion.position_noise", "-1"}},
      {"tools/bench/run/look.cpp", {"look", "POINTS", "-o", "o.png"}, {"a world of points has no pictures"}},
      {"tools/bench/run/look.cpp", {"look", "TINY", "-o", "o.txt"}, {"o.txt", "'.png'"}},
      {"tools/bench/run/track.cpp", {"track", "pictures", "-o", "o"}, {"camera.yaml", "--camera PRESET|FILE"}},
      // Trajectories.
      {"tools/judge/evaluation/text_file.cpp",
       {"evaluate", "nowhere.txt", "--truth", "one.txt"},
       {"nowhere.txt", "cannot be opened"}},
      {"tools/judge/evaluation/text_file.cpp",
       {"evaluate", "nan.txt", "--truth", "one.txt"},
       {"nan.txt:2:5", "'nan' is not a finite number"}},
      {"tools/judge/evaluation/trajectory.cpp",
       {"evaluate", "comments.txt", "--truth", "one.txt"},
       {"comments.txt", "holds no pose"}},
      {"tools/judge/evaluation/trajectory.cpp",
       {"evaluate", "one.txt", "--truth", "still"},
       {"still/velocity.txt", "holds no velocity"}},
      {"tools/judge/evaluation/association.cpp",
       {"evaluate", "one.txt", "--truth", "nine.txt"},
       {"the estimate covers 1.0", "the truth 9.0", "gap allowed"}},
      {"tools/judge/evaluation/compat/evo.cpp",
       {"evaluate", "line.txt", "--truth", "line.txt", "--compat", "evo ape -a"},
       {"on one line", "leave out -a"}},
      {"tools/judge/evaluation/compat/openvins.cpp",
       {"evaluate", "one.txt", "--truth", "nine.txt", "--compat", "ov se3"},
       {"less than two poses in common"}},
      {"tools/judge/evaluation/compat/tum.cpp",
       {"evaluate", "one.txt", "--truth", "nine.txt", "--compat", "tum rpe"},
       {"no pair of poses is left"}},
      {"tools/vobench/compat.cpp",
       {"evaluate", "one.txt", "--truth", "one.txt", "--compat", "kitti"},
       {"'kitti'", "tum [ate|rpe], evo ape|rpe, rpg, ov MODE"}},
      {"tools/vobench/compat.cpp",
       {"evaluate", "line.txt", "--truth", "line.txt", "--compat", "evo rpe --delta 1.5"},
       {"--delta 1.5", "frames are counted whole"}},
      {"tools/bench/run/evaluate.cpp", {"evaluate", "one.txt", "--truth", "empty"}, {"empty", "groundtruth.txt"}},
      {"tools/bench/run/evaluate.cpp",
       {"evaluate", "one.txt", "--truth", "pictures"},
       {"pictures", "no groundtruth.txt in it"}},
      // Outputs.
      {"tools/bench/result/output_folder.cpp",
       {"run", "TINY", "-o", "taken"},
       {"taken", "not made by this command", "choose another name"}},
      {"tools/bench/result/output_folder.cpp", {"run", "TINY", "-o", "one.txt"}, {"one.txt", "no folder"}},
      {"tools/bench/tracking/map_file.cpp",
       {"run", "POINTS", "--map", "map.txt"},
       {"--map map.txt", "the name must end in .ply"}},
      {"tools/bench/tracking/map_file.cpp",
       {"run", "POINTS", "--map", "no/map.ply"},
       {"--map no/map.ply", "no folder no", "make it first"}},
      {"tools/bench/run/render.cpp",
       {"render", "TINY", "-o", "o", "--frames", "100:200"},
       {"--frames 100:200", "0 to 29"}},
      {"tools/vobench/option_table.cpp",
       {"render", "TINY", "-o", "o", "--frames", "5"},
       {"--frames", "'5'", "A:B with 0 <= A < B"}},
      {"tools/vobench/option_table.cpp",
       {"check", "TINY", "--set", "camera.width"},
       {"--set", "'camera.width' is not key=value"}},
      {"tools/bench/run/run.cpp", {"run", "TINY", "--bound"}, {"--bound is for worlds of points", "tiny.yaml"}},
      {"tools/bench/run/run_points.cpp",
       {"run", "POINTS", "--verdict", "--runs", "3"},
       {"10 runs or more, not 3", "--runs 100"}},
      {"tools/bench/run/run_points.cpp",
       {"run", "POINTS", "--set", "seed=3"},
       {"--set seed=3: each run has a world of its own; say --seed 3"}},
      {"tools/bench/points/point_bound.cpp",
       {"run", "POINTS", "--bound", "--set", "time.duration=0.1 s", "--set", "world.points.measurement.noise=0"},
       {"no Cramer-Rao bound", "no noise"}},
      {"tools/bench/systems/experiment.cpp",
       {"check", "TINY", "--set", "odometry.filter.particles=-2"},
       {"--set odometry.filter.particles", "'-2'", "1 ... "}},
      {"tools/bench/run/run_common.cpp", {"report", "nowhere"}, {"nowhere: has no run.json", "`run` or `track`"}},
      {"tools/judge/verification/files.cpp", {"verify", "nowhere"}, {"nowhere/rgb.txt", "is not there, and is needed"}},
      {"tools/bench/run/export.cpp",
       {"export", "nowhere", "--bag", "one.txt"},
       {"--bag one.txt", "choose another name"}},
      // Campaigns.
      {"tools/bench/campaign/plan.cpp",
       {"campaign", "campaign.yaml", "-o", "o"},
       {"campaign.yaml:2:", "no system 'nosuch'", "there are rb2pf", "'3..1' is no range"}},
      {"tools/bench/campaign/campaign_file.cpp",
       {"campaign", "theirs.yaml", "-o", "o"},
       {"theirs.yaml:3:", "'set': what is not ours is set in its command"}},
  };
  return all;
}

class MessagesTest : public testing::Test {
 protected:
  void SpoiltFiles() {
    const std::string pose = " 0 0 0 0 0 0 1\n";
    WriteFile(here_ / "one.txt", "1" + pose);
    WriteFile(here_ / "nine.txt", "9" + pose);
    WriteFile(here_ / "nan.txt", "1.0" + pose + "1.1 nan 0 0 0 0 0 1\n1.2" + pose);
    WriteFile(here_ / "comments.txt", "# nothing\n");
    WriteFile(here_ / "line.txt", "1 0 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n3 2 0 0 0 0 0 1\n");
    WriteFile(here_ / "broken.yaml", "a: [1, 2\n");
    WriteFile(here_ / "half.yaml", "{width: 3, fx: 1}\n");
    WriteFile(here_ / "broken.obj", "v 0 0 0\nf 1 2 9\n");
    const std::string size("\0\0\0\rIHDR\0\0\0\1\0\0\0\1\x8\2\0\0\0", 21), sum = "\x90\x77\x53\xDE";
    const std::string png = "\x89PNG\r\n\x1a\n" + size + sum,
                      no_sum = "\x89PNG\r\n\x1a\n" + size + "xxxx" + std::string("\0\0\0\0IEND\xae\x42\x60\x82", 12);
    const std::string jpeg("\xff\xd8\xff\xc0\0\x0b\x8\0\1\0\1\1\1\x11\0xxx", 18);
    for (const auto& [name, content] : {std::pair{"cut.png", png},
                                        {"sum.png", no_sum},
                                        {"chunk.png", png + std::string("\0\0\1\0IHDRxxxx", 12)},
                                        {"mark.jpg", jpeg}}) {
      const std::string picture = name;
      WriteFile(here_ / (picture + ".obj"),
                "mtllib " + picture + ".mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n");
      WriteFile(here_ / (picture + ".mtl"), "newmtl m\nmap_Kd " + picture + "\n");
      WriteFile(here_ / picture, content);
    }
    const std::string xml = "<?xml version=\"1.0\"?>\n<opencv_storage>\n<image_height>480</image_height>\n";
    WriteFile(here_ / "opencv.xml",
              xml + "<image_width>0</image_width>\n<camera_matrix>5</camera_matrix>\n</opencv_storage>\n");
    WriteFile(
        here_ / "none.xml",
        xml +
            "<image_width>640</image_width>\n<camera_matrix type_id=\"opencv-matrix\"><rows>3</rows><cols>3</cols>"
            "<dt>d</dt><data>.Nan 0. 1. 0. 1. 1. 0. 0. 1.</data></camera_matrix>\n</opencv_storage>\n");
    WriteFile(here_ / "opencv.yaml", "%YAML:1.0\n---\nimage_width: 0\nimage_height: 480\ncamera_matrix: 5\n");
    WriteFile(
        here_ / "none.yaml",
        "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\ncamera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n"
        "   dt: d\n   data: [ .Nan, 0., 1., 0., 1., 1., 0., 0., 1. ]\n");
    WriteFile(here_ / "still" / "groundtruth.txt", "1" + pose);
    WriteFile(here_ / "still" / "velocity.txt", "# none\n");
    WriteFile(here_ / "taken" / "thesis.tex", "years of work");
    fs::create_directory(here_ / "empty");
    WriteFile(here_ / "lists" / "rgb.txt", "0.1 a.png\n0.1 b.png\n0.2\n");
    WriteFile(here_ / "pictures" / "rgb.txt", "0.1 a.png\n");
    WriteFile(here_ / "pictures" / "a.png", "x");
    WriteFile(here_ / "nothing" / "rgb.txt", "0.1 a.png\n");
    WriteFile(here_ / "nothing" / "a.png", "");
    WriteFile(here_ / "floats" / "rgb.txt", "0.1 a.png\n");
    WriteFile(here_ / "floats" / "a.png", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\nabcd");
    WriteFile(here_ / "systems.yaml", "systems: [{name: theirs, command: 'true', layout: tum}]\n");
    WriteFile(here_ / "theirs.yaml", "scenarios: [{file: " + TinyScenario().string() +
                                         "}]\nexternal: systems.yaml\nsystems: [{name: theirs, set: "
                                         "{odometry.filter.particles: 3}}]\nseeds: 1..3\n");
    WriteFile(here_ / "campaign.yaml",
              "scenarios: [{file: " + TinyScenario().string() + "}]\nsystems: [nosuch]\nseeds: 3..1\n");
  }
  std::string Filled(std::string word) const {
    std::string lamps;  // more different flickers than can be baked
    for (int i = 0; i < 40; ++i) {
      lamps +=
          "{type: point, position: [0, 2.5, 0], intensity: [1, 1, 1], flicker: {frequency: " + std::to_string(50 + i) +
          " Hz, depth: 0.3, phase: 0 deg}}, ";
    }
    const std::pair<std::string, std::string> stands_for[] = {
        {"TINY", TinyScenario().string()},
        {"POINTS", (TinyScenario().parent_path() / "points.yaml").string()},
        {"FOLDER", here_.path().string()},
        {"FLICKERS", "[" + lamps + "]"}};
    for (const auto& [name, value] : stands_for) {
      if (const std::size_t at = word.find(name); at != std::string::npos) word.replace(at, name.size(), value);
    }
    return word;
  }
  TemporaryFolder here_;
};

TEST_F(MessagesTest, EachNamesPlaceAndReason) {
  SpoiltFiles();
  const auto before = Tree(here_.path());
  for (const Message& message : Messages()) {
    Words arguments;
    for (const std::string& word : message.arguments) arguments.push_back(Filled(word));
    const Outcome outcome = RunVobench(arguments, here_.path());
    const std::string what = message.source + ": " + testing::PrintToString(message.arguments);
    EXPECT_EQ(outcome.status, 2) << what << outcome.err;
    for (const std::string& words : message.says) EXPECT_THAT(outcome.err, testing::HasSubstr(words)) << what;
    EXPECT_TRUE(Tree(here_.path()) == before) << what << " left something behind";
  }
}

}  // namespace
}  // namespace vobench::system_test

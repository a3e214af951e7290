#include <console_bridge/console.h>
#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cstdlib>
#include <glm/gtc/quaternion.hpp>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "sim/world/mesh_loader.h"
#include "sim/world/texture.h"
#include "sim/world/texture_file.h"
#include "tools/base/files.h"
#include "tools/base/text.h"
#include "tools/bench/import/import.h"
#include "tools/bench/import/urdf.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpedantic"
#include <sdf/sdf.hh>
#pragma GCC diagnostic pop

namespace vobench {
namespace {

namespace fs = std::filesystem;
using Pose = ignition::math::Pose3d;

constexpr double kHalf = std::numbers::sqrt2 / 2;  // of quarter turns
const glm::dquat kYUp(kHalf, -kHalf, 0, 0);        // W from SDF's z up

glm::dvec3 Vector(const ignition::math::Vector3d& v) { return {v.X(), v.Y(), v.Z()}; }
glm::dquat Quaternion(const ignition::math::Quaterniond& q) { return {q.W(), q.X(), q.Y(), q.Z()}; }
glm::dvec3 Linear(const glm::dvec3& srgb) {
  const glm::dvec3 c = glm::clamp(srgb, 0.0, 1.0);
  return {sim::SrgbToLinear(c.r), sim::SrgbToLinear(c.g), sim::SrgbToLinear(c.b)};
}
glm::dvec3 Linear(const ignition::math::Color& c) { return Linear(glm::dvec3(c.R(), c.G(), c.B())); }

// Raw coordinates of a COLLADA file, which are SDF's, from those with y up, as it is loaded.
glm::dquat RawFromYUp(const fs::path& file) {
  if (sim::LowerExtension(file) != ".dae") return {1, 0, 0, 0};
  const std::string text = base::ReadFile(file).value_or(""), tag = "<up_axis>";
  const std::size_t at = text.find(tag), axis = text.find_first_not_of(" \t\r\n", at + tag.size());
  if (at == std::string::npos || axis == std::string::npos) return {1, 0, 0, 0};
  if (text.compare(axis, 4, "Z_UP") == 0) return {kHalf, kHalf, 0, 0};
  return text.compare(axis, 4, "X_UP") == 0 ? glm::dquat(kHalf, 0, 0, -kHalf) : glm::dquat(1, 0, 0, 0);
}

// Messages of the URDF reader.
class UrdfMessages : public console_bridge::OutputHandler {
 public:
  void log(const std::string& text, console_bridge::LogLevel, const char*, int) override { all.push_back(text); }
  std::vector<std::string> all;
};

constexpr char kModelsRemedy[] = "; --models names folders of models, fetched before";

class Reader {
 public:
  Reader(const fs::path& file, const std::vector<fs::path>& folders, fs::path shapes)
      : file_(fs::absolute(file)), shapes_(std::move(shapes)), folders_(folders) {
    const fs::path here = file_.parent_path(), above = here.parent_path();
    folders_.insert(folders_.end(), {here, here / "models", above, above / "models"});
    for (const char* name : {"GAZEBO_MODEL_PATH", "GZ_SIM_RESOURCE_PATH", "IGN_GAZEBO_RESOURCE_PATH", "SDF_PATH"}) {
      const char* value = std::getenv(name);
      std::istringstream list(value == nullptr ? "" : value);
      for (std::string folder; std::getline(list, folder, ':');) folders_.emplace_back(folder);
    }
    if (const char* home = std::getenv("HOME")) folders_.push_back(fs::path(home) / ".gazebo/models");
  }

  ImportedWorld Read() {
    RequireXml();
    sdf::Console::Instance()->SetQuiet(true);
    sdf::ParserConfig config;
    config.SetWarningsPolicy(sdf::EnforcementPolicy::LOG);
    config.SetUnrecognizedElementsPolicy(sdf::EnforcementPolicy::LOG);
    config.SetFindCallback([this](const std::string& uri) { return Find(uri, file_).string(); });
    sdf::Root root;
    UrdfMessages messages;  // invalid SDF is tried as URDF, whose reader prints its problems
    console_bridge::useOutputHandler(&messages);
    Note(urdf_.empty() ? root.Load(file_.string(), config) : root.LoadSdfString(urdf_, config));
    console_bridge::noOutputHandler();
    if (!problems_.empty() && !urdf_.empty() && !messages.all.empty())  // libsdformat's own has the whole text
      throw std::runtime_error(file_.string() + ": " + base::Join(messages.all, "; "));
    if (problems_.empty() && root.WorldCount() > 0) ReadWorld(*root.WorldByIndex(0));
    if (root.WorldCount() > 1) warnings_.Add(file_.string() + ": ", "worlds after the first are left out");
    if (problems_.empty() && root.Model() != nullptr) ReadModel(*root.Model(), Pose::Zero, root.Model()->Name());
    if (const std::size_t read = result_.world.meshes.size(); problems_.empty() && read < urdf_visuals_)
      problems_.insert(fmt::format("{}: of its {} visuals only {} can be read{}{}", file_.string(), urdf_visuals_, read,
                                   messages.all.empty() ? "" : ": ", base::Join(messages.all, "; ")));
    if (!problems_.empty()) throw std::runtime_error(base::Join({problems_.begin(), problems_.end()}, "\n"));
    result_.warnings = warnings_.Summed();
    if (result_.world.meshes.empty())
      throw std::runtime_error(base::Join(result_.warnings, "\n") + (result_.warnings.empty() ? "" : "\n") +
                               file_.string() + ": has no visuals that are read");
    return std::move(result_);
  }

 private:
  // Checks for XML, of which libsdformat only reports that it cannot be read.
  void RequireXml() {
    tinyxml2::XMLDocument xml;
    if (xml.LoadFile(file_.c_str()) != tinyxml2::XML_SUCCESS)
      throw std::runtime_error(
          fmt::format("{}:{}: is not XML: {}", file_.string(), xml.ErrorLineNum(), xml.ErrorName()));
    const std::string name = xml.RootElement()->Name();
    if (name != "sdf" && name != "gazebo" && name != "robot")
      throw std::runtime_error(file_.string() + ": is neither SDF nor URDF: its element is <" + name + ">");
    ForEachElement(*xml.RootElement(), [&](tinyxml2::XMLElement& element) {
      const std::string text = element.GetText() == nullptr ? "" : element.GetText();
      if (text.find(',') != std::string::npos && text.find_first_not_of("0123456789+-.,eE \t\r\n") == std::string::npos)
        Reject(
            file_.string(), element.GetLineNum(),
            fmt::format("<{}>: '{}' has commas: numbers have points, and blanks between them", element.Name(), text));
    });
    if (!problems_.empty()) throw std::runtime_error(base::Join({problems_.begin(), problems_.end()}, "\n"));
    if (name == "robot") urdf_ = ReadableUrdf(file_, xml, urdf_visuals_, warnings_);
  }

  // Of a URDF libsdformat gives "urdf file" instead of a file.
  static bool IsFile(const fs::path& file) {
    std::error_code error;
    return fs::is_regular_file(file, error);
  }

  void Reject(const std::string& file, std::optional<int> line, const std::string& what) {
    const bool is_file = IsFile(file);
    problems_.insert((is_file ? file : file_.string()) + (is_file && line ? ":" + std::to_string(*line) : "") + ": " +
                     what);
  }
  // Notes all errors but those that repeat for an outer element, or the file, that it cannot be read either.
  void Note(const sdf::Errors& errors) {
    bool repeats = false;
    for (const sdf::Error& error : errors) {
      const std::string what = error.Message();
      const bool is_outer = what.starts_with("Error reading element") || what.starts_with("Unable to read file");
      const bool is_missing = what.starts_with("Unable to find uri");
      if (!(is_outer && repeats))
        Reject(error.FilePath().value_or(""), error.LineNumber(), what + (is_missing ? kModelsRemedy : ""));
      repeats = is_outer;
    }
  }

  // The file or folder of a URI in the file `from`; empty: it does not exist.
  fs::path Find(const std::string& uri, const fs::path& from) const {
    const std::size_t scheme = uri.find("://");
    const std::string name = scheme == std::string::npos ? uri : uri.substr(scheme + 3);
    std::error_code error;
    if (uri.starts_with("http") || name.empty()) return {};
    const fs::path beside = (IsFile(from) ? fs::absolute(from) : file_).parent_path() / name;
    if (!uri.starts_with("model:") && fs::exists(beside, error)) return beside;
    for (const fs::path& folder : folders_) {
      if (fs::exists(folder / name, error)) return (folder / name).lexically_normal();
    }
    // A package that this file is in, at any depth.
    for (fs::path up = file_.parent_path(); up.has_relative_path(); up = up.parent_path()) {
      if (up.filename() == *fs::path(name).begin() && fs::exists(up.parent_path() / name, error))
        return (up.parent_path() / name).lexically_normal();
    }
    return {};
  }
  // Folder that textures may be read from. All files would be below the root.
  void AddFolder(const fs::path& folder) {
    if (folder.has_relative_path()) result_.world.folders.push_back(folder);
  }
  // Of MODEL/meshes/FILE the whole model, where it is one: no other folder that happens to be above.
  void AddFoldersOf(const fs::path& mesh) {
    const fs::path folder = mesh.parent_path(), model = folder.parent_path();
    std::error_code error;
    const bool is_model = model == file_.parent_path() || fs::exists(model / "model.config", error) ||
                          fs::exists(model / "package.xml", error);
    AddFolder(folder.filename() == "meshes" && is_model ? model : folder);
    if (fs::is_directory(model / "materials", error)) AddFolder(model / "materials");
  }
  fs::path Require(const std::string& uri, const std::string& from, const sdf::ElementPtr& at) {
    const fs::path found = Find(uri, from);
    if (found.empty()) Reject(at->FilePath(), at->LineNumber(), uri + ": no such file" + kModelsRemedy);
    return found;
  }

  template <class Part>
  Pose Resolved(const Part& part, const Pose& parent) {
    Pose pose;
    Note(part.SemanticPose().Resolve(pose));
    return parent * pose;
  }

  // Gazebo shades with power * cos, so that a white surface under power 1 is white: an irradiance of pi.
  void ReadWorld(const sdf::World& in) {
    const sdf::Scene scene = in.Scene() == nullptr ? sdf::Scene() : *in.Scene();
    result_.lights = {"{type: ambient, radiance: " + ListText(Linear(scene.Ambient())) + "}"};
    if (scene.Sky() != nullptr)
      result_.lights.emplace_back("{type: sky, zenith: [0.2, 0.35, 0.8], horizon: [0.7, 0.75, 0.9]}");
    result_.background = Linear(scene.Background());
    if (in.Scene() != nullptr && in.Scene()->Element()->HasElement("fog")) warnings_.Add("", "a <fog> is left out");
    if (!scene.Shadows()) warnings_.Add("", "<shadows> is false: there are shadows all the same");
    for (std::uint64_t i = 0; i < in.ModelCount(); ++i)
      ReadModel(*in.ModelByIndex(i), Pose::Zero, in.ModelByIndex(i)->Name());
    for (std::uint64_t i = 0; i < in.LightCount(); ++i) ReadLight(*in.LightByIndex(i), Pose::Zero);
    for (std::uint64_t i = 0; i < in.ActorCount(); ++i)
      warnings_.Add("'" + in.ActorByIndex(i)->Name() + "': ", "actors are left out");
    for (const char* name : {"road", "population"}) {
      if (in.Element()->HasElement(name)) warnings_.Add("", std::string("a <") + name + "> is left out");
    }
    if (in.Element()->HasElement("state"))
      warnings_.Add("", "<state> is not applied: models are at their poses outside it");
  }

  // model: the outermost one that it belongs to.
  void ReadModel(const sdf::Model& in, const Pose& parent, const std::string& model) {
    const Pose pose = Resolved(in, parent);
    for (std::uint64_t i = 0; i < in.ModelCount(); ++i) ReadModel(*in.ModelByIndex(i), pose, model);
    for (std::uint64_t i = 0; i < in.LinkCount(); ++i) {
      const sdf::Link& link = *in.LinkByIndex(i);
      const Pose of_link = Resolved(link, pose);
      for (std::uint64_t k = 0; k < link.VisualCount(); ++k) ReadVisual(*link.VisualByIndex(k), of_link, model);
      for (std::uint64_t k = 0; k < link.LightCount(); ++k) ReadLight(*link.LightByIndex(k), of_link);
    }
  }

  void ReadLight(const sdf::Light& in, const Pose& parent) {
    const sdf::ElementPtr element = in.Element();
    if (element->HasElement("light_on") && !element->Get<bool>("light_on")) return;
    const Pose pose = Resolved(in, parent);
    const glm::dvec3 power = std::numbers::pi * in.Intensity() * Linear(in.Diffuse());
    const glm::dvec3 way = kYUp * Vector(pose.Rot().RotateVector(in.Direction())), place = kYUp * Vector(pose.Pos());
    constexpr double kAt = 3;  // [m], where a lamp is as bright as Gazebo's
    const double fade = in.ConstantAttenuationFactor() + kAt * in.LinearAttenuationFactor() +
                        kAt * kAt * in.QuadraticAttenuationFactor();
    if (in.Type() == sdf::LightType::DIRECTIONAL) {
      const std::string irradiance = ListText(power);
      return result_.lights.push_back("{type: sun, direction: " + ListText(way) + ", irradiance: " + irradiance + "}");
    }
    const std::string intensity = ListText(kAt * kAt / std::max(fade, 0.01) * power);
    result_.lights.push_back("{type: point, position: " + ListText(place) + ", intensity: " + intensity + "}");
    const std::string who = "light '" + in.Name() + "': ";
    warnings_.Add(who, "attenuation is that of the squared distance, equally bright at 3 m");
    if (in.Type() == sdf::LightType::SPOT) warnings_.Add(who, "a spot light shines to all sides");
  }

  void ReadVisual(const sdf::Visual& visual, const Pose& parent, const std::string& model) {
    sim::MeshDescription mesh;
    const std::string who = "model '" + model + "', visual '" + visual.Name() + "': ";
    const sdf::Geometry& geometry = *visual.Geom();
    const Pose pose = Resolved(visual, parent);
    glm::dquat turn(1, 0, 0, 0);  // before the pose
    mesh.name = model + "/" + visual.Name();
    while (!names_.insert(mesh.name).second) mesh.name += "_";
    mesh.category = model.substr(0, std::max<std::size_t>(1, model.find_last_not_of("0123456789_ ") + 1));
    const auto shape = [&](const char* name, const glm::dvec3& size) {
      mesh.file = shapes_ / name, mesh.stretch = size, mesh.color = Linear(glm::dvec3(0.7));
    };
    if (const auto* box = geometry.BoxShape()) {
      shape("box.obj", Vector(box->Size()));
    } else if (const auto* sphere = geometry.SphereShape()) {
      shape("sphere.obj", glm::dvec3(sphere->Radius()));
    } else if (const auto* ellipsoid = geometry.EllipsoidShape()) {
      shape("sphere.obj", Vector(ellipsoid->Radii()));
    } else if (const auto* cylinder = geometry.CylinderShape()) {
      shape("cylinder.obj", {cylinder->Radius(), cylinder->Radius(), cylinder->Length()});
    } else if (const auto* plane = geometry.PlaneShape()) {
      shape("plane.obj", {plane->Size().X(), plane->Size().Y(), 1});
      ignition::math::Quaterniond to_normal;
      to_normal.From2Axes(ignition::math::Vector3d::UnitZ, plane->Normal());
      turn = Quaternion(to_normal);
      result_.planes.insert(mesh.name);
    } else if (const auto* from = geometry.MeshShape()) {
      mesh.file = Require(from->Uri(), from->FilePath(), from->Element());
      turn = RawFromYUp(mesh.file);
      const glm::dmat3 turned = glm::mat3_cast(turn);  // by a quarter or not: its squares swap the factors
      mesh.stretch = glm::transpose(glm::matrixCompMult(turned, turned)) * Vector(from->Scale());
      if (!from->Submesh().empty()) warnings_.Add(who, "a submesh is not picked out: the whole file is taken");
      AddFoldersOf(mesh.file);
    } else {
      return warnings_.Add(who, kUnknownShape);
    }
    if (const glm::dvec3& s = mesh.stretch; geometry.MeshShape() == nullptr && !(std::min({s.x, s.y, s.z}) > 0))
      Reject(visual.Element()->FilePath(), visual.Element()->LineNumber(),
             fmt::format("{}its shape has a size of {}", who, std::min({s.x, s.y, s.z})));
    if (const sdf::Material* material = visual.Material()) ReadMaterial(*material, who, mesh);
    if (!mesh.texture.empty()) AddFolder(mesh.texture.parent_path());
    if (visual.Transparency() > 0 || (visual.Material() != nullptr && visual.Material()->Diffuse().A() < 1))
      warnings_.Add(who, "transparency is not rendered: it is opaque");
    if (!visual.CastShadows()) warnings_.Add(who, "it casts a shadow all the same");
    mesh.position = kYUp * Vector(pose.Pos());
    mesh.orientation = glm::normalize(kYUp * Quaternion(pose.Rot()) * turn);
    result_.world.meshes.push_back(mesh);
  }

  void ReadMaterial(const sdf::Material& in, const std::string& who, sim::MeshDescription& mesh) {
    if (in.Element()->HasElement("emissive")) WarnOfEmission(Linear(in.Emissive()) != glm::dvec3(0), who);
    if (in.Element()->HasElement("diffuse")) mesh.color = Linear(in.Diffuse());
    for (const auto type : {sdf::PbrWorkflowType::METAL, sdf::PbrWorkflowType::SPECULAR}) {
      const auto* flow = in.PbrMaterial() == nullptr ? nullptr : in.PbrMaterial()->Workflow(type);
      if (flow == nullptr) continue;
      if (!(flow->NormalMap() + flow->RoughnessMap() + flow->MetalnessMap() + flow->GlossinessMap()).empty())
        warnings_.Add(who, "maps of normals, roughness and metalness are left out");
      WarnOfEmission(!flow->EmissiveMap().empty(), who);
      if (flow->AlbedoMap().empty()) continue;
      mesh.texture = Require(flow->AlbedoMap(), in.FilePath(), in.Element());
      if (!in.Element()->HasElement("diffuse")) mesh.color = glm::dvec3(1);
    }
    if (!in.ScriptName().empty()) ReadScript(in, who, mesh);
  }

  void WarnOfEmission(bool is_emissive, const std::string& who) {
    if (is_emissive) warnings_.Add(who, "emission is not rendered: lights alone make it bright");
  }

  void ReadScript(const sdf::Material& in, const std::string& who, sim::MeshDescription& mesh) {
    std::vector<fs::path> scripts, pictures;
    for (auto uri = in.Element()->GetElement("script")->GetElement("uri"); uri; uri = uri->GetNextElement("uri")) {
      scripts.push_back(Find(uri->Get<std::string>(), in.FilePath()));
      const fs::path folder = fs::is_directory(scripts.back()) ? scripts.back() : scripts.back().parent_path();
      pictures.insert(pictures.end(), {folder, folder.parent_path() / "textures"});
    }
    const auto material = FindOgreMaterial(in.ScriptName(), scripts);
    if (!material)
      return warnings_.Add(who + "'" + in.ScriptName() + "': ", "a material that is in no script is left out");
    mesh.color = material->diffuse ? Linear(*material->diffuse) : glm::dvec3(1);
    WarnOfEmission(material->is_emissive, who);
    if (material->texture.empty()) return;
    if (material->is_scaled) warnings_.Add(who, "the scale of a script's texture is not applied");
    const auto has = [&](const fs::path& folder) { return fs::is_regular_file(folder / material->texture); };
    const auto folder = std::ranges::find_if(pictures, has);
    if (folder != pictures.end()) return void(mesh.texture = *folder / material->texture);
    Reject(in.FilePath(), in.Element()->LineNumber(),
           "no texture " + material->texture + " for '" + in.ScriptName() + "'");
  }

  fs::path file_, shapes_;
  std::string urdf_;               // its text; empty: it is SDF
  std::size_t urdf_visuals_ = 0;   // in it, of a known shape
  std::vector<fs::path> folders_;  // of models
  ImportedWorld result_;
  sim::WarningList warnings_;
  std::set<std::string> problems_, names_;
};

}  // namespace

fs::path ModelOf(const fs::path& folder) { return sdf::getModelFilePath(folder.string()); }

ImportedWorld ReadSdf(const fs::path& file, const std::vector<fs::path>& folders, const fs::path& shapes) {
  return Reader(file, folders, shapes).Read();
}

}  // namespace vobench

#include "tools/bench/import/urdf.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <glm/vec4.hpp>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace vobench {

namespace fs = std::filesystem;

void ForEachElement(tinyxml2::XMLElement& of, const std::function<void(tinyxml2::XMLElement&)>& call) {
  for (auto* child = of.FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
    call(*child);
    ForEachElement(*child, call);
  }
}

std::string ReadableUrdf(const fs::path& file, tinyxml2::XMLDocument& xml, std::size_t& visuals,
                         sim::WarningList& warnings) {
  std::vector<tinyxml2::XMLElement*> unknown, textures;
  ForEachElement(*xml.RootElement(), [&](tinyxml2::XMLElement& element) {
    const std::string name = element.Name();
    bool is_macro = name.starts_with("xacro:");
    for (const auto* a = element.FirstAttribute(); a != nullptr; a = a->Next())
      is_macro = is_macro || std::string_view(a->Value()).find("${") != std::string_view::npos;
    if (is_macro)
      throw std::runtime_error(fmt::format("{}:{}: is xacro, not URDF: expand it (`xacro {} > robot.urdf`)",
                                           file.string(), element.GetLineNum(), file.filename().string()));
    if (name == "texture") textures.push_back(&element);
    if (name != "visual") return;
    const auto* geometry = element.FirstChildElement("geometry");
    const auto* shape = geometry == nullptr ? nullptr : geometry->FirstChildElement();
    const std::string kind = shape == nullptr ? "none" : shape->Name();
    if (kind == "box" || kind == "sphere" || kind == "cylinder" || kind == "mesh") return void(++visuals);
    warnings.Add(fmt::format("{}:{}: ", file.string(), element.GetLineNum()), kUnknownShape);
    unknown.push_back(&element);
  });
  for (tinyxml2::XMLElement* texture : textures) {
    tinyxml2::XMLElement* const material = texture->Parent()->ToElement();
    warnings.Add(fmt::format("{}:{}: ", file.string(), texture->GetLineNum()), "a texture of URDF is left out: grey");
    material->DeleteChild(texture);
    if (material->FirstChildElement("color") == nullptr)
      material->InsertNewChildElement("color")->SetAttribute("rgba", "0.7 0.7 0.7 1");
  }
  std::set<std::string> materials;
  ForEachElement(*xml.RootElement(), [&](tinyxml2::XMLElement& element) {
    const char* const rgba = element.Attribute("rgba");
    if (std::string_view(element.Name()) == "material" && element.FirstChildElement("color") != nullptr)
      materials.insert(element.Attribute("name") == nullptr ? "" : element.Attribute("name"));
    if (std::string_view(element.Name()) != "color" || rgba == nullptr) return;
    std::istringstream numbers(rgba);
    glm::dvec4 c;
    const bool has_all = static_cast<bool>(numbers >> c.r >> c.g >> c.b >> c.a);
    for (int i = 0; i < 4; ++i) {
      if (!has_all || !(c[i] >= 0 && c[i] <= 1))
        throw std::runtime_error(fmt::format("{}:{}: rgba=\"{}\": expected four numbers from 0 to 1", file.string(),
                                             element.GetLineNum(), rgba));
    }
    c *= glm::dvec4(0.8, 0.8, 0.8, 1);  // libsdformat divides by 0.8
    element.SetAttribute("rgba", fmt::format("{} {} {} {}", c.r, c.g, c.b, c.a).c_str());
  });
  ForEachElement(*xml.RootElement(), [&](tinyxml2::XMLElement& element) {
    const char* const name = element.Attribute("name");
    if (std::string_view(element.Name()) == "material" && name != nullptr && !materials.contains(name))
      warnings.Add(fmt::format("{}:{}: '{}': ", file.string(), element.GetLineNum(), name),
                   "a material without a color is left out: grey");
  });
  for (tinyxml2::XMLElement* visual : unknown) visual->Parent()->DeleteChild(visual);
  for (auto* link = xml.RootElement()->FirstChildElement("link"); link; link = link->NextSiblingElement("link")) {
    if (link->Attribute("name", "world") != nullptr) continue;
    while (auto* const given = link->FirstChildElement("inertial")) link->DeleteChild(given);
    auto* const inertial = link->InsertNewChildElement("inertial");
    inertial->InsertNewChildElement("mass")->SetAttribute("value", 1);
    auto* const inertia = inertial->InsertNewChildElement("inertia");
    for (const char* name : {"ixx", "iyy", "izz", "ixy", "ixz", "iyz"})
      inertia->SetAttribute(name, name[1] == name[2] ? 1 : 0);
  }
  tinyxml2::XMLPrinter printer;
  xml.Print(&printer);
  return printer.CStr();
}

}  // namespace vobench

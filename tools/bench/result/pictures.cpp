#include "tools/bench/result/pictures.h"

#include <cmath>

#include "tools/base/files.h"
#include "tools/base/limits/structured_text.h"
#include "tools/base/text.h"
#include "tools/bench/result/json_file.h"

namespace vobench {
namespace {

using Json = nlohmann::ordered_json;
namespace ev = evaluation;
namespace fs = std::filesystem;

constexpr const char* kFormat = "vobench pictures 1";
constexpr const char* kScaleFormat = "vobench truth pictures 1";
constexpr const char* kStatus[] = {"matched", "missed", "rejected", "new"};

// Hundredths of a pixel are enough to draw.
double Rounded(double pixel) { return std::round(100 * pixel) / 100; }

Json Of(const FeatureMark& m) {
  Json numbers = {Rounded(m.predicted.x()), Rounded(m.predicted.y()), Rounded(m.pixel.x()), Rounded(m.pixel.y())};
  for (const double s : {m.covariance(0, 0), m.covariance(0, 1), m.covariance(1, 1)}) numbers.push_back(Rounded(s));
  return {{"status", kStatus[static_cast<std::size_t>(m.status)]}, {"at", numbers}};
}

FeatureMark MarkFrom(const Json& json) {
  FeatureMark mark;
  const auto name = json.at("status").get<std::string>();
  const auto found = std::find(std::begin(kStatus), std::end(kStatus), name);
  if (found == std::end(kStatus)) throw ev::InputError({"'" + name + "' is no status of a feature"});
  mark.status = static_cast<FeatureMark::Status>(found - std::begin(kStatus));
  const auto at = json.at("at").get<std::array<double, 7>>();
  mark.predicted = {at[0], at[1]};
  mark.pixel = {at[2], at[3]};
  mark.covariance << at[4], at[5], at[5], at[6];
  return mark;
}

bool IsDrawable(const FeatureMark& mark) {
  const auto below = [](const auto& values, double most) { return (values.array().abs() < most).all(); };
  return below(mark.pixel, 1e5) && below(mark.predicted, 1e5) && below(mark.covariance, 1e8);
}

}  // namespace

fs::path PicturePath(std::int64_t stamp_ns) { return fs::path("frames") / (base::FormatSeconds(stamp_ns) + ".jpg"); }

void WritePictures(const fs::path& run_folder, const KeptPictures& pictures) {
  Json json = {
      {"format", kFormat}, {"width", pictures.width}, {"height", pictures.height}, {"pictures", Json::array()}};
  for (const KeptPicture& picture : pictures.pictures) {
    Json features = Json::array();
    for (const FeatureMark& mark : picture.features) {
      if (IsDrawable(mark)) features.push_back(Of(mark));
    }
    json["pictures"].push_back({{"timestamp", base::FormatSeconds(picture.stamp_ns)}, {"features", features}});
  }
  base::WriteFile(run_folder / "pictures.json", json.dump() + "\n");
}

KeptPictures ReadPictures(const fs::path& run_folder) {
  const fs::path file = run_folder / "pictures.json";
  if (!fs::exists(file)) return {};
  return ReadJson(file, kFormat, [](const Json& json) {
    KeptPictures kept;
    kept.width = limits::WholeNumber<int>(json.at("width")).value_or(0);
    kept.height = limits::WholeNumber<int>(json.at("height")).value_or(0);
    if (kept.width < 1 || kept.height < 1)
      throw ev::InputError({"width and height must be whole numbers of 1 or more, not " + json.at("width").dump() +
                            " and " + json.at("height").dump()});
    for (const Json& entry : json.at("pictures")) {
      KeptPicture& picture = kept.pictures.emplace_back();
      const auto stamp = base::ParseSeconds(entry.at("timestamp").get<std::string>());
      if (!stamp) throw ev::InputError({entry.at("timestamp").dump() + " is no time"});
      picture.stamp_ns = *stamp;
      for (const Json& feature : entry.at("features")) picture.features.push_back(MarkFrom(feature));
    }
    return kept;
  });
}

void WriteTruthScale(const fs::path& out, const TruthScale& scale) {
  const Json json = {{"format", kScaleFormat},
                     {"nearest_m", scale.nearest_m},
                     {"farthest_m", scale.farthest_m},
                     {"largest_flow_px", scale.largest_flow_px}};
  base::WriteFile(out / "truth" / "scale.json", json.dump() + "\n");
}

TruthScale ReadTruthScale(const fs::path& out) {
  const fs::path file = out / "truth" / "scale.json";
  if (!fs::exists(file)) return {};
  return ReadJson(file, kScaleFormat, [](const Json& json) {
    return TruthScale{json.at("nearest_m").get<double>(), json.at("farthest_m").get<double>(),
                      json.at("largest_flow_px").get<double>()};
  });
}

fs::path DepthPath(std::int64_t stamp_ns) { return fs::path("truth") / (base::FormatSeconds(stamp_ns) + "_depth.jpg"); }
fs::path FlowPath(std::int64_t stamp_ns) { return fs::path("truth") / (base::FormatSeconds(stamp_ns) + "_flow.jpg"); }

}  // namespace vobench

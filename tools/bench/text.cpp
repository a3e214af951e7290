#include "tools/bench/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "tools/base/text.h"

namespace vobench {
namespace {

// Width in characters: bytes that continue a UTF-8 character have none.
std::size_t Width(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

}  // namespace

std::string Fixed(double value, int decimals) {
  if (!std::isfinite(value)) return "–";
  return base::Fixed(value, decimals);
}

std::string Readable(double value) {
  if (!std::isfinite(value)) return "–";
  const double size = std::abs(value);
  if (size != 0 && (size >= 1e5 || size < 1e-3)) return fmt::format("{:.1e}", value);
  return Fixed(value, size >= 100 ? 0 : size >= 10 ? 1 : size >= 1 ? 2 : 3);
}

std::string Percent(double share, int decimals) {
  return std::isfinite(share) ? Fixed(100 * share, decimals) + " %" : "–";
}

std::string DisplayName(const std::string& system) {
  static const std::map<std::string, std::string> names = {{"rb2pf", "RB²-PF"},
                                                           {"rbpf", "RB-PF"},
                                                           {"fastslam1", "FastSLAM 1.0"},
                                                           {"ekfslam", "EKF-SLAM"},
                                                           {"rb2pf_paper", "RB²-PF, paper"},
                                                           {"rbpf_paper", "RB-PF, paper"}};
  const auto found = names.find(system);
  return found == names.end() ? system : found->second;
}

std::string Count(std::size_t n, const std::string& noun) {
  return std::to_string(n) + " " + noun + (n == 1 ? "" : "s");
}

std::string Escape(const std::string& text) {
  static const std::map<char, const char*> entities = {
      {'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\'', "&#39;"}};
  return Replaced(text, entities);
}

std::string AlignedTable(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths(rows.front().size());
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], Width(row[i]));
  }
  std::string text;
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string room(widths[i] - Width(row[i]), ' ');
      text += i == 0 ? row[i] + room : "  " + room + row[i];
    }
    text += '\n';
  }
  return text;
}

std::string Base64(const std::string& bytes) {
  static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k <= bytes.size() ? digits[group >> (18 - 6 * k) & 63u] : '=';
    }
  }
  return text;
}

std::string Replaced(const std::string& text, const std::map<char, const char*>& replacements) {
  std::string out;
  for (const char c : text) {
    const auto found = replacements.find(c);
    found == replacements.end() ? out += c : out += found->second;
  }
  return out;
}

std::string QuotedForYaml(const std::string& text) { return nlohmann::json(text).dump(); }

std::string QuotedForShell(const std::string& text) { return "'" + Replaced(text, {{'\'', "'\\''"}}) + "'"; }

}  // namespace vobench

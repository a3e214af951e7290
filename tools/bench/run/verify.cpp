#include "tools/judge/verification/verify.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "tools/bench/errors.h"
#include "tools/bench/progress.h"
#include "tools/bench/run/commands.h"

namespace vobench {
namespace {

using Row = verification::Check;

void Print(const Row& check) {
  if (check.count() == 0) {
    fmt::print("{:<56} {:>11} {:>11} {:<9}  -\n", check.name(), "", "", "");
    return;
  }
  const bool has_size = std::isfinite(check.value()) && check.bound() > 0;
  fmt::print("{:<56} {:>11} {:>11} {:<9}  {:<4} {}\n", check.name(),
             has_size ? fmt::format("{:.3g}", check.value()) : "", has_size ? fmt::format("{:.3g}", check.bound()) : "",
             check.unit(), check.failed() ? "FAIL" : "pass", check.failed() ? "" : "at " + check.where());
  constexpr std::size_t kShown = 4;
  for (std::size_t i = 0; i < check.failures().size() && i < kShown; ++i) fmt::print("    {}\n", check.failures()[i]);
  if (check.failures().size() > kShown) fmt::print("    and {} more\n", check.failures().size() - kShown);
}

}  // namespace

void Verify(const VerifyOptions& options) {
  std::vector<Row> checks;
  {
    std::optional<Progress> progress;
    try {
      checks = verification::Verify(options.sequence, [&](std::size_t, std::size_t all) {
        if (!progress) progress.emplace("verifying", static_cast<std::int64_t>(all));
        progress->Step(1);
      });
    } catch (const Interrupted&) {
      throw;
    } catch (const std::runtime_error& error) {
      throw BadInput(WordsOf(error));
    }
  }
  fmt::print("{:<56} {:>11} {:>11} {:<9}  verdict\n", "check", "worst", "bound", "unit");
  std::size_t failed = 0, made = 0;
  for (const Row& check : checks) {
    Print(check);
    failed += check.failed();
    made += check.count() > 0;
  }
  fmt::print("{} of {} checks made, {} failed; - : the sequence has not what it needs\n", made, checks.size(), failed);
  if (failed > 0) throw std::runtime_error(fmt::format("{}: its streams disagree", options.sequence.string()));
}

}  // namespace vobench

// Search for the mildest combination of stresses that breaks a system, without derivatives.
//
// A combination is a point of [0, 1]^n, 0 the mildest value of each parameter and 1 the most severe; its mildness is
// its Euclidean norm. Along a direction the norm at which the system breaks is found by bisection; directions are
// searched by Nelder and Mead's simplex on subspaces (Rowan, "Functional stability analysis of numerical algorithms",
// 1990; NLopt's SBPLX). Parameters that are not needed to break the system are set back to 0.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace vobench::breaking {

using Combination = std::vector<double>;
// Whether the system breaks. Each call is an evaluation; a point of the grid is evaluated once.
using Breaks = std::function<bool(const Combination&)>;

struct AttackOptions {
  std::size_t parameters = 0;
  int evaluations = 200;  // at most
  int grid = 256;         // points are multiples of 1 / grid
};

struct AttackResult {
  bool found = false;
  Combination at;       // that breaks it
  double norm = 0;      // of it
  int evaluations = 0;  // that were made
};

AttackResult SearchAttack(const AttackOptions& options, const Breaks& breaks);

}  // namespace vobench::breaking

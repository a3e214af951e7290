// Updates of an information matrix, its inner loops: lower triangles, column by column, in vector code that is chosen
// at run time. All instruction sets give the same bits.
#pragma once

#include <Eigen/Core>

#include "vo/base/instruction_set.h"

namespace vo {

// A -= Y Y', A: lower triangle (above its diagonal A is undefined afterwards).
void SubtractSquare(const Eigen::Ref<const Eigen::MatrixXd>& Y, Eigen::Ref<Eigen::MatrixXd> A,
                    InstructionSet set = BestInstructionSet());

// What a view of an anchored landmark adds: A_ii += X J, A_jj += Z K, A_ij += X K, with X = J'W of the view's pose i,
// Z = K'W of the anchor's pose j. `Z`, `K`: null where the anchor is no variable.
template <int kSize>
struct ViewProducts {
  const double *X, *J, *Z, *K;  // X, Z: the first kSize rows of kRateSlotSize x 2; J, K: 2 x kSize
  double *A_ii, *A_jj, *A_ij;   // columns `stride` apart
  Eigen::Index stride;
};
template <int kSize>
void AddProducts(const ViewProducts<kSize>& products, InstructionSet set = BestInstructionSet());

}  // namespace vo

#include "vo/filter/information_update.h"

#include "vo/base/vectors.h"
#include "vo/filter/path_linearisation.h"

namespace vo {
namespace {

constexpr Eigen::Index kLanes = 4, kColumns = 4;  // of a tile: two vectors of rows
using Doubles = Vector<double, kLanes>;

struct Square {
  const double* Y;
  double* A;
  Eigen::Index rows, columns, Y_stride, A_stride;

  // Rows i ... i + kVectors kLanes - 1 of columns j ... j + kWidth - 1.
  template <int kVectors, int kWidth>
  [[gnu::always_inline]] void Tile(Eigen::Index i, Eigen::Index j) const {
    Doubles sum[kWidth][kVectors] = {};
    const double *y = Y + i, *factor = Y + j;
    for (Eigen::Index k = 0; k < columns; ++k, y += Y_stride, factor += Y_stride)
      for (int c = 0; c < kWidth; ++c)
        for (int v = 0; v < kVectors; ++v) sum[c][v] += Load<Doubles>(y + v * kLanes) * factor[c];
    double* a = A + j * A_stride + i;
    for (int c = 0; c < kWidth; ++c, a += A_stride)
      for (int v = 0; v < kVectors; ++v) Store(Load<Doubles>(a + v * kLanes) - sum[c][v], a + v * kLanes);
  }
  template <int kWidth>
  [[gnu::always_inline]] void Columns(Eigen::Index j) const {
    Eigen::Index i = j;
    for (; i + 2 * kLanes <= rows; i += 2 * kLanes) Tile<2, kWidth>(i, j);
    for (; i + kLanes <= rows; i += kLanes) Tile<1, kWidth>(i, j);
    for (; i < rows; ++i)
      for (int c = 0; c < kWidth; ++c) {
        double sum = 0;
        for (Eigen::Index k = 0; k < columns; ++k) sum += Y[k * Y_stride + i] * Y[k * Y_stride + j + c];
        A[(j + c) * A_stride + i] -= sum;
      }
  }
};

[[gnu::always_inline]] inline void Subtract(const Square& square) {
  Eigen::Index j = 0;
  for (; j + kColumns <= square.rows; j += kColumns) square.Columns<kColumns>(j);
  for (; j < square.rows; ++j) square.Columns<1>(j);
}

// A += X J.
template <int kSize>
[[gnu::always_inline]] inline void AddProduct(const double* X, const double* J, double* A, Eigen::Index stride) {
  for (int c = 0; c < kSize; ++c, A += stride, J += 2) {
    const double left = J[0], right = J[1];
    int r = 0;
    for (; r + kLanes <= kSize; r += kLanes)
      Store(Load<Doubles>(A + r) + (Load<Doubles>(X + r) * left + Load<Doubles>(X + kRateSlotSize + r) * right), A + r);
    for (; r < kSize; ++r) A[r] += X[r] * left + X[kRateSlotSize + r] * right;
  }
}
template <int kSize>
[[gnu::always_inline]] inline void Add(const ViewProducts<kSize>& p) {
  AddProduct<kSize>(p.X, p.J, p.A_ii, p.stride);
  if (p.Z == nullptr) return;
  AddProduct<kSize>(p.Z, p.K, p.A_jj, p.stride);
  AddProduct<kSize>(p.X, p.K, p.A_ij, p.stride);
}

#ifdef __x86_64__
[[gnu::target("avx2")]] void SubtractByAvx2(const Square& square) { Subtract(square); }
template <int kSize>
[[gnu::target("avx2")]] void AddByAvx2(const ViewProducts<kSize>& products) {
  Add(products);
}
#endif

}  // namespace

void SubtractSquare(const Eigen::Ref<const Eigen::MatrixXd>& Y, Eigen::Ref<Eigen::MatrixXd> A,
                    [[maybe_unused]] InstructionSet set) {
  const Square square{Y.data(), A.data(), Y.rows(), Y.cols(), Y.outerStride(), A.outerStride()};
#ifdef __x86_64__
  if (set != InstructionSet::base) return SubtractByAvx2(square);
#endif
  Subtract(square);
}

template <int kSize>
void AddProducts(const ViewProducts<kSize>& products, [[maybe_unused]] InstructionSet set) {
#ifdef __x86_64__
  if (set != InstructionSet::base) return AddByAvx2(products);
#endif
  Add(products);
}
template void AddProducts(const ViewProducts<kPoseSize>&, InstructionSet);
template void AddProducts(const ViewProducts<kRateSlotSize>&, InstructionSet);

}  // namespace vo

// Scores of a Gaussian-mixture belief given the truth: unlike NEES valid far from Gaussian, too.
// Source: Gneiting & Raftery, "Strictly proper scoring rules", JASA 2007 (energy score); Talts et al.,
// "Validating Bayesian inference algorithms with simulation-based calibration", 2018 (ranks).
//
// All vectors are in the tangent space at the mean of the belief, in the order of the covariance: (dp in W, dphi in C,
// dv in W, dw in C). The functions take any dimension; Block() cuts one out.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "tools/judge/evaluation/consistency.h"

namespace evaluation {

// Parts of the twelve dimensions that are scored separately.
struct StateBlock {
  const char* name;
  int start, size;  // size: degrees of freedom
};
inline constexpr std::array<StateBlock, 7> kStateBlocks{{{"position", 0, 3},
                                                         {"orientation", 3, 3},
                                                         {"linear velocity", 6, 3},
                                                         {"angular velocity", 9, 3},
                                                         {"pose", 0, 6},
                                                         {"velocity", 6, 6},
                                                         {"joint", 0, 12}}};

// NEES by kStateBlocks; NaN where the covariance of the block is not positive definite.
using BlockNees = std::array<double, kStateBlocks.size()>;

struct MixtureComponent {
  double weight = 1;           // need not be normalised
  Eigen::VectorXd offset;      // the component's mean less the mixture's mean
  Eigen::MatrixXd covariance;  // positive semi-definite: a sampled dimension has none
};
using Mixture = std::vector<MixtureComponent>;

Mixture Block(const Mixture& mixture, const StateBlock& block);

// Mean (zero, if the offsets are as they should be) and covariance sum w_i (P_i + mu_i mu_i').
struct Moments {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
};
Moments MomentsOf(const Mixture& mixture);

// 1 / sum w_i^2.
double EffectiveComponents(const Mixture& mixture);

// One column per draw.
Eigen::MatrixXd Draw(const Mixture& mixture, int draws, std::uint64_t seed, std::uint64_t stream);

// Per dimension, how many of the draws lie below the error: uniform on 0 ... draws if the belief is calibrated.
std::vector<int> Ranks(const Eigen::MatrixXd& draws, const Eigen::VectorXd& error);

// The share of the mixture's mass at higher density than the error: uniform on (0, 1) if the belief is calibrated, so
// that the highest-density region of probability c covers the truth in a share c of the runs. By draws, (hits + 1/2) /
// (n + 1); exact, by chi-square, for a single component. NaN when there is no density.
double HpdMass(const Mixture& mixture, const Eigen::MatrixXd& draws, const Eigen::VectorXd& error);

// E|X - e| - E|X - X'| / 2, from draws, without bias (all pairs of different draws). Smaller is better; in the unit of
// the error, so only for blocks of one unit. NaN with fewer than two draws.
double EnergyScore(const Eigen::MatrixXd& draws, const Eigen::VectorXd& error);

// All scores of one frame.
struct MixtureScores {
  std::array<double, 7> nees{};  // of the matched moments, by kStateBlocks; NaN without a positive definite covariance
  std::array<double, 7> hpd_mass{};  // by kStateBlocks; NaN without a density
  std::array<double, 4> energy{};    // of the first four of kStateBlocks [m, rad, m/s, rad/s]
  std::array<int, 12> rank{};        // of the truth among `draws` draws
  int draws = 0;
  double effective_components = 0;
};

// `error` is truth less the mixture's mean. `stream` names the frame and run: equal streams share their random numbers.
// draws: 2 or more; ranks divide evenly into b bins when draws + 1 is a multiple of b. Or 0, to save time (many
// particles, frames whose ranks are not needed): no ranks, energies NaN, coverage of one Gaussian only. Throws
// std::invalid_argument listing every problem (no component, a weight below zero or no positive one, a dimension other
// than 12, numbers not finite).
MixtureScores ScoreMixture(const Mixture& mixture, const Vector12d& error, std::uint64_t stream, int draws = 99,
                           std::uint64_t seed = 1);

}  // namespace evaluation

#ifndef TAPA_TESTS_MVS_REFERENCE_H_
#define TAPA_TESTS_MVS_REFERENCE_H_

#include <vector>

#include "src/mvs/cpu/problem_data.h"
#include "src/mvs/options.h"
#include "src/mvs/problem.h"
#include "src/mvs/sweep/depth_normal.h"

// The algorithm once more, as literally and slowly as possible, in double
// precision and without sharing code with the engine but the random numbers:
// what the engine is compared with.
namespace tapa::reference {

// 1 - NCC of the window around a reference pixel with its image in source view
// m, the window being warped by the plane's homography.
double PhotometricCost(const Options& options, const Problem& problem, int row,
                       int col, const DepthNormal& plane, int m);

// Forward-backward reprojection error in pixels, truncated.
double GeometricCost(const Options& options, const Problem& problem, int row,
                     int col, double depth, int m);

double Emission(const Options& options, double cost);
double ForwardMessage(double emission, double previous);
double BackwardMessage(double emission, double next);
double SelectionProb(double forward, double backward, double previous,
                     double previous_weight);

// Product of the three priors of a source view.
double Prior(const Options& options, const Problem& problem, int row, int col,
             const DepthNormal& plane, int m);

// State of all pixels, values of the views at [pixel * sources + m].
struct State {
  Map<float> depth;
  Map<Vec3> normal;
  std::vector<double> cost;
  std::vector<double> prob;
  // The hypothesis (src/mvs/sweep/hypotheses.h) that each pixel chose last.
  Map<uint8_t> chosen;
};

// Costs as the engine stores them, in steps of 2 / 65535.
double RoundCost(double cost);

State Initialize(const Options& options, const Problem& problem,
                 const Map<float>& depth, const Map<Vec3>& normal);

// What textureness t makes of the two terms of a cost: w+ = (1 - range) + range
// t and w- = 1 - range t.
double PlusWeight(double t, double range);
double MinusWeight(double t, double range);

// One sweep without filter; `index` counts sweeps from 0, its remainder by 4
// gives the direction.
void Sweep(const Options& options, const Problem& problem,
           const GuideMaps& guide, int index, State* state);

struct Position {
  int row;
  int col;
};

// Pixels of one line of a sweep in its order. Directions 0 to 3 are down, left,
// up, right; lines are columns in the first and third, otherwise rows.
std::vector<Position> LinePixels(const Problem& problem, int direction,
                                 int line);

// Number of views that support the estimate of a pixel in the last sweep.
int CountConsistent(const Options& options, const Problem& problem, int row,
                    int col, const DepthNormal& plane, const double* prob);

}  // namespace tapa::reference

#endif  // TAPA_TESTS_MVS_REFERENCE_H_

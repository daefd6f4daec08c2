/// Explicit Runge-Kutta methods as tables.
///
///   k_i = f(t + c_i h, x + h sum_j a_ij k_j)        x_1 = x + h sum_i b_i k_i                      (1)
///   error = h sum_i e_i k_i                          (solution kept minus embedded solution)       (2)
///   x(t + theta h) = x + h sum_i k_i sum_j p_ij theta^(j+1),  0 <= theta <= 1                      (3)
///
/// Where `kFirstSameAsLast`, the last stage sits at x_1: it is the first stage of the next step.
#pragma once

#include <array>
#include <string_view>

namespace palpate {

template <int kStageCount, int kDenseDegreeCount>
struct TableauBase {
  static constexpr int kStages = kStageCount;
  static constexpr int kDenseDegree = kDenseDegreeCount;
  using Row = std::array<double, kStageCount>;
  using Matrix = std::array<Row, kStageCount>;
  using Dense = std::array<std::array<double, kDenseDegreeCount>, kStageCount>;
};

/// Euler's method; for comparison only.
struct Euler : TableauBase<1, 1> {
  static constexpr std::string_view kName = "euler";
  static constexpr int kOrder = 1, kEmbeddedOrder = 0, kDenseOrder = 1;
  static constexpr bool kFirstSameAsLast = false;
  static constexpr Matrix a{};
  static constexpr Row b{1.0}, c{0.0}, e{};
  static constexpr Dense p{{{1.0}}};
};

/// The classical method of Kutta 1901; the third-order dense output of its own four stages (Hairer,
/// Norsett, Wanner 1993, II.6).
struct Rk4 : TableauBase<4, 3> {
  static constexpr std::string_view kName = "rk4";
  static constexpr int kOrder = 4, kEmbeddedOrder = 0, kDenseOrder = 3;
  static constexpr bool kFirstSameAsLast = false;
  static constexpr Matrix a{{{}, {0.5}, {0.0, 0.5}, {0.0, 0.0, 1.0}}};
  static constexpr Row b{1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6}, c{0.0, 0.5, 0.5, 1.0}, e{};
  static constexpr Dense p{
      {{1.0, -3.0 / 2, 2.0 / 3}, {0.0, 1.0, -2.0 / 3}, {0.0, 1.0, -2.0 / 3}, {0.0, -1.0 / 2, 2.0 / 3}}};
};

/// Bogacki and Shampine 1989: third order with an embedded second; cubic Hermite dense output.
struct Bs32 : TableauBase<4, 3> {
  static constexpr std::string_view kName = "bs32";
  static constexpr int kOrder = 3, kEmbeddedOrder = 2, kDenseOrder = 3;
  static constexpr bool kFirstSameAsLast = true;
  static constexpr Matrix a{{{}, {0.5}, {0.0, 0.75}, {2.0 / 9, 1.0 / 3, 4.0 / 9}}};
  static constexpr Row b{2.0 / 9, 1.0 / 3, 4.0 / 9, 0.0}, c{0.0, 0.5, 0.75, 1.0};
  static constexpr Row e{2.0 / 9 - 7.0 / 24, 1.0 / 3 - 1.0 / 4, 4.0 / 9 - 1.0 / 3, -1.0 / 8};
  static constexpr Dense p{
      {{1.0, -4.0 / 3, 5.0 / 9}, {0.0, 1.0, -2.0 / 3}, {0.0, 4.0 / 3, -8.0 / 9}, {0.0, -1.0, 1.0}}};
};

/// Fehlberg 1969, RK3(4): advances with third order and controls the step by the fourth, as the tracer of
/// Ikits 2006, sec. 6.6 does; cubic Hermite dense output.
struct Rk34 : TableauBase<5, 3> {
  static constexpr std::string_view kName = "rk34";
  static constexpr int kOrder = 3, kEmbeddedOrder = 4, kDenseOrder = 3;
  static constexpr bool kFirstSameAsLast = true;
  static constexpr Matrix a{{{},
                             {1.0 / 4},
                             {4.0 / 81, 32.0 / 81},
                             {57.0 / 98, -432.0 / 343, 1053.0 / 686},
                             {1.0 / 6, 0.0, 27.0 / 52, 49.0 / 156}}};
  static constexpr Row b{1.0 / 6, 0.0, 27.0 / 52, 49.0 / 156, 0.0}, c{0.0, 1.0 / 4, 4.0 / 9, 6.0 / 7, 1.0};
  static constexpr Row e{1.0 / 6 - 43.0 / 288, 0.0, 27.0 / 52 - 243.0 / 416, 49.0 / 156 - 343.0 / 1872,
                         -1.0 / 12};
  // Hermite: x + (3 theta^2 - 2 theta^3) (x_1 - x) + h (theta - 2 theta^2 + theta^3) k_1
  //            + h (theta^3 - theta^2) k_5, with x_1 - x from (1).
  static constexpr Dense p{{{1.0, 3.0 / 6 - 2.0, -2.0 / 6 + 1.0},
                            {},
                            {0.0, 3.0 * 27.0 / 52, -2.0 * 27.0 / 52},
                            {0.0, 3.0 * 49.0 / 156, -2.0 * 49.0 / 156},
                            {0.0, -1.0, 1.0}}};
};

/// Dormand and Prince 1980, RK5(4)7M; fourth-order dense output of Shampine 1986.
struct Dp54 : TableauBase<7, 4> {
  static constexpr std::string_view kName = "dp54";
  static constexpr int kOrder = 5, kEmbeddedOrder = 4, kDenseOrder = 4;
  static constexpr bool kFirstSameAsLast = true;
  static constexpr Matrix a{{{},
                             {1.0 / 5},
                             {3.0 / 40, 9.0 / 40},
                             {44.0 / 45, -56.0 / 15, 32.0 / 9},
                             {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
                             {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
                             {35.0 / 384, 0.0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}}};
  static constexpr Row b{35.0 / 384, 0.0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84, 0.0};
  static constexpr Row c{0.0, 1.0 / 5, 3.0 / 10, 4.0 / 5, 8.0 / 9, 1.0, 1.0};
  static constexpr Row e{71.0 / 57600,      0.0,        -71.0 / 16695, 71.0 / 1920,
                         -17253.0 / 339200, 22.0 / 525, -1.0 / 40};
  static constexpr Dense p{
      {{1.0, -8048581381.0 / 2820520608.0, 8663915743.0 / 2820520608.0, -12715105075.0 / 11282082432.0},
       {},
       {0.0, 131558114200.0 / 32700410799.0, -68118460800.0 / 10900136933.0, 87487479700.0 / 32700410799.0},
       {0.0, -1754552775.0 / 470086768.0, 14199869525.0 / 1410260304.0, -10690763975.0 / 1880347072.0},
       {0.0, 127303824393.0 / 49829197408.0, -318862633887.0 / 49829197408.0,
        701980252875.0 / 199316789632.0},
       {0.0, -282668133.0 / 205662961.0, 2019193451.0 / 616988883.0, -1453857185.0 / 822651844.0},
       {0.0, 40617522.0 / 29380423.0, -110615467.0 / 29380423.0, 69997945.0 / 29380423.0}}};
};

}  // namespace palpate

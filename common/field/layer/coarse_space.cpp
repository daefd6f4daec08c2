#include "common/field/layer/coarse_space.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

#include "common/base/index.h"
#include "common/base/parallel.h"

namespace palpate {
namespace {

using Matrix = Eigen::SparseMatrix<double>;

/// Unknowns of a part, on average, at least, and parts of the whole, at most: E is factored in a moment then.
/// Parts are some five unknowns wide, in systems of a million a little more.
constexpr std::size_t kPartSize = 128, kMostParts = 8000;
/// Of the strongest coupling of an unknown: weaker ones join no part.
constexpr double kStrong = 0.25;
constexpr std::int32_t kNone = -1;

/// A symmetric matrix of which only columns of the same block are kept, by rows.
struct Graph {
  std::vector<std::size_t> begin;
  std::vector<std::int32_t> columns;
  std::vector<double> weights;

  [[nodiscard]] std::size_t size() const { return begin.size() - 1; }
};

Graph graph_of_block(const Matrix& a, Eigen::Index first, Eigen::Index last) {
  Graph graph{.begin = {0}, .columns = {}, .weights = {}};
  for (Eigen::Index row = first; row < last; ++row) {
    for (Matrix::InnerIterator at(a, row); at; ++at) {
      if (at.index() < first || at.index() >= last) continue;
      graph.columns.push_back(static_cast<std::int32_t>(at.index() - first));
      graph.weights.push_back(at.value());
    }
    graph.begin.push_back(graph.columns.size());
  }
  return graph;
}

/// The part of each unknown. @return how many parts there are.
std::int32_t grow_parts(const Graph& graph, std::vector<std::int32_t>& part) {
  part.assign(graph.size(), kNone);
  std::int32_t count = 0;
  const auto for_strong = [&](std::size_t row, const auto& act) {
    double strongest = 0.0;
    for (std::size_t n = graph.begin[row]; n < graph.begin[row + 1]; ++n)
      if (as_size(graph.columns[n]) != row) strongest = std::max(strongest, -graph.weights[n]);
    for (std::size_t n = graph.begin[row]; n < graph.begin[row + 1]; ++n) {
      const auto other = as_size(graph.columns[n]);
      if (other != row && strongest > 0.0 && -graph.weights[n] >= kStrong * strongest)
        act(other, -graph.weights[n]);
    }
  };
  // Whole neighbourhoods first.
  for (std::size_t row = 0; row < graph.size(); ++row) {
    if (part[row] != kNone) continue;
    bool taken = false;
    for_strong(row, [&](std::size_t other, double) { taken = taken || part[other] != kNone; });
    if (taken) continue;
    part[row] = count;
    for_strong(row, [&](std::size_t other, double) { part[other] = count; });
    ++count;
  }
  // What is left between them goes to the one that it is coupled to most.
  const std::vector<std::int32_t> whole = part;
  for (std::size_t row = 0; row < graph.size(); ++row) {
    if (part[row] != kNone) continue;
    double most = 0.0;
    for_strong(row, [&](std::size_t other, double weight) {
      if (whole[other] == kNone || weight <= most) return;
      most = weight;
      part[row] = whole[other];
    });
    if (part[row] == kNone) part[row] = count++;
  }
  return count;
}

/// Z^T A Z of a graph whose unknowns are in `count` parts.
Graph coarser(const Graph& graph, const std::vector<std::int32_t>& part, std::int32_t count) {
  const auto parts = as_size(count);
  std::vector<std::size_t> next(parts + 1, 0);
  for (const std::int32_t p : part) ++next[as_size(p) + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  const std::vector<std::size_t> first = next;
  std::vector<std::size_t> members(part.size());
  for (std::size_t row = 0; row < part.size(); ++row) members[next[as_size(part[row])]++] = row;
  Graph coarse{.begin = {0}, .columns = {}, .weights = {}};
  std::vector<std::size_t> place(parts, 0);  // one past the entry of the row at hand, where there is one
  for (std::size_t p = 0; p < parts; ++p) {
    const std::size_t begin = coarse.columns.size();
    for (std::size_t m = first[p]; m < first[p + 1]; ++m) {
      for (std::size_t n = graph.begin[members[m]]; n < graph.begin[members[m] + 1]; ++n) {
        const std::int32_t column = part[as_size(graph.columns[n])];
        std::size_t& at = place[as_size(column)];
        if (at <= begin) {
          coarse.columns.push_back(column);
          coarse.weights.push_back(0.0);
          at = coarse.columns.size();
        }
        coarse.weights[at - 1] += graph.weights[n];
      }
    }
    coarse.begin.push_back(coarse.columns.size());
  }
  return coarse;
}

/// Parts of `size` unknowns of the block and more. @return how many.
std::int32_t parts_of_block(const Matrix& a, Eigen::Index first, Eigen::Index last, std::size_t size,
                            std::span<std::int32_t> part_of) {
  Graph graph = graph_of_block(a, first, last);
  std::iota(part_of.begin(), part_of.end(), 0);
  std::vector<std::int32_t> part;
  auto count = static_cast<std::int32_t>(graph.size());
  while (as_size(count) * size > part_of.size() && count > 1) {
    const std::int32_t fewer = grow_parts(graph, part);
    if (fewer == count) break;
    for (std::int32_t& p : part_of) p = part[as_size(p)];
    graph = coarser(graph, part, fewer);
    count = fewer;
  }
  return count;
}

}  // namespace

CoarseSpace::CoarseSpace(const Matrix& a, std::span<const Eigen::Index> begin, int threads)
    : part_of_(as_size(a.rows())) {
  const std::size_t blocks = begin.size() - 1, size = std::max(kPartSize, part_of_.size() / kMostParts);
  std::vector<std::int32_t> counts(blocks, 0);
  parallel_for(blocks, threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) {
      if (begin[n] == begin[n + 1]) continue;
      counts[n] =
          parts_of_block(a, begin[n], begin[n + 1], size,
                         std::span(part_of_).subspan(as_size(begin[n]), as_size(begin[n + 1] - begin[n])));
    }
  });
  for (std::size_t n = 0; n < blocks; ++n) {
    for (Eigen::Index row = begin[n]; row < begin[n + 1]; ++row)
      part_of_[as_size(row)] += static_cast<std::int32_t>(parts_);
    parts_ += counts[n];
  }

  begin_.push_back(0);
  if (parts_ == 0) return;
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<std::size_t> place(as_size(parts_), 0);
  for (Eigen::Index row = 0; row < a.rows(); ++row) {
    const std::size_t first = columns_.size();
    for (Matrix::InnerIterator at(a, row); at; ++at) {
      const std::int32_t column = part_of_[as_size(at.index())];
      std::size_t& entry = place[as_size(column)];
      if (entry <= first) {
        columns_.push_back(column);
        weights_.push_back(0.0);
        entry = columns_.size();
      }
      weights_[entry - 1] += at.value();
    }
    begin_.push_back(columns_.size());
    for (std::size_t n = first; n < columns_.size(); ++n)
      entries.emplace_back(part_of_[as_size(row)], columns_[n], weights_[n]);
  }
  Matrix e(parts_, parts_);
  e.setFromTriplets(entries.begin(), entries.end());
  factor_.compute(e);
}

void CoarseSpace::sum(const Eigen::VectorXd& v, Eigen::Index first, Eigen::Index last,
                      Eigen::VectorXd& sums) const {
  for (Eigen::Index row = first; row < last; ++row) sums[part_of_[as_size(row)]] = 0.0;
  for (Eigen::Index row = first; row < last; ++row) sums[part_of_[as_size(row)]] += v[row];
}

void CoarseSpace::subtract_product(const Eigen::VectorXd& y, Eigen::Index first, Eigen::Index last,
                                   Eigen::VectorXd& v) const {
  for (Eigen::Index row = first; row < last; ++row) {
    double product = 0.0;
    for (std::size_t n = begin_[as_size(row)]; n < begin_[as_size(row) + 1]; ++n)
      product += weights_[n] * y[columns_[n]];
    v[row] -= product;
  }
}

void CoarseSpace::add_values(const Eigen::VectorXd& y, Eigen::Index first, Eigen::Index last,
                             Eigen::VectorXd& v) const {
  for (Eigen::Index row = first; row < last; ++row) v[row] += y[part_of_[as_size(row)]];
}

}  // namespace palpate

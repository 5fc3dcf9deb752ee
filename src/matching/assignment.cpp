#include "matching/assignment.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "matching/assignment_problem.hpp"

namespace igsp {
namespace {

constexpr std::int32_t none = -1;
constexpr std::int64_t infinite = std::numeric_limits<std::int64_t>::max();

/// Successive shortest augmenting paths from the rows; every row has a private dummy column at the cost `threshold`.
/// Between steps u <= threshold, v <= 0, u + v <= cost, with equality on matched edges; a free column has v = 0 and a
/// row that is done without a column u = threshold.
class Solver {
 public:
  struct Row {
    std::int64_t u = 0;
    std::int32_t column = none;
  };
  struct Column {
    std::int64_t v = 0;
    std::int64_t distance = infinite;  // from the start of the running search
    std::int32_t row = none;
    std::int32_t predecessor = none;  // the row from which the running search reached it
  };

  Solver(AssignmentRows entries, std::size_t columns, std::int64_t threshold)
      : entries_(std::move(entries)), threshold_(threshold), rows_(entries_.size()), columns_(columns) {}

  void solve() {
    std::vector<std::int32_t> left = match_greedily();
    for (int pass = 0; pass < 2; ++pass) left = bid_for_columns(left);
    for (const std::int32_t row : left) augment(row);
  }

  const std::vector<Row>& rows() const { return rows_; }
  const std::vector<Column>& columns() const { return columns_; }

 private:
  void match(std::int32_t row, std::int32_t column) {
    rows_[row].column = column;
    columns_[column].row = row;
  }

  /// u = least cost, and every row takes a free column at that cost. Returns the rows left over.
  std::vector<std::int32_t> match_greedily() {
    std::vector<std::int32_t> left;
    for (std::int32_t row = 0; row < static_cast<std::int32_t>(rows_.size()); ++row) {
      const std::span<const AssignmentRows::Entry> entries = entries_[row];
      rows_[row].u = entries.empty() ? threshold_ : entries.front().cost;
      for (const AssignmentRows::Entry& entry : entries) {
        if (entry.cost > rows_[row].u) break;
        if (columns_[entry.column].row != none) continue;
        match(row, entry.column);
        break;
      }
      if (rows_[row].column == none && !entries.empty()) left.push_back(row);
    }
    return left;
  }

  struct Bid {
    std::int64_t least, second;  // of the reduced costs, the dummy's among them
    std::int32_t column = none;
    bool column_is_free = true;
  };

  Bid best_bid(std::int32_t row) const {
    Bid bid{threshold_, threshold_};
    for (const AssignmentRows::Entry& entry : entries_[row]) {
      if (entry.cost >= bid.second && (bid.column_is_free || entry.cost > bid.least)) break;
      const Column& column = columns_[entry.column];
      const std::int64_t reduced = entry.cost - column.v;
      if (reduced < bid.least) {
        bid = {reduced, bid.least, entry.column, column.row == none};
      } else if (reduced == bid.least && !bid.column_is_free && column.row == none) {
        bid = {reduced, reduced, entry.column, true};
      } else {
        bid.second = std::min(bid.second, reduced);
      }
    }
    return bid;
  }

  /// Augmenting row reduction (Jonker and Volgenant 1987): a row takes the column of its least reduced cost, lowers the
  /// column's potential as far as that stays its best choice, and the row it displaced goes on. Cheap, and leaves few
  /// rows for the searches. Bounded, since prices can fall in small steps for long.
  std::vector<std::int32_t> bid_for_columns(const std::vector<std::int32_t>& rows) {
    std::vector<std::int32_t> left;
    std::size_t budget = 20 * rows.size();
    for (std::int32_t row : rows) {
      while (row != none) {
        const Bid bid = best_bid(row);
        rows_[row].u = bid.least;
        if (bid.column == none) break;  // its dummy is the best it can ever get, since v only falls
        const std::int32_t displaced = columns_[bid.column].row;
        if (displaced != none) {
          if (bid.least == bid.second || budget == 0) {
            left.push_back(row);
            break;
          }
          --budget;
          rows_[row].u = bid.second;
          columns_[bid.column].v -= bid.second - bid.least;
          rows_[displaced].column = none;
        }
        match(row, bid.column);
        row = displaced;
      }
    }
    return left;
  }

  /// Where a search found its end: a free column, or a row that gives up its column for its dummy.
  struct PathEnd {
    std::int64_t distance = infinite;
    std::int32_t column = none;
    std::int32_t row = none;
  };

  struct Reached {
    std::int64_t distance;
    std::int32_t column;
  };
  struct Farther {
    bool operator()(const Reached& a, const Reached& b) const { return a.distance > b.distance; }
  };

  void augment(std::int32_t start) {
    const PathEnd end = shortest_path(start);
    rows_[start].u += end.distance;
    for (const std::int32_t scanned : scanned_) {
      Column& column = columns_[scanned];
      const std::int64_t change = end.distance - column.distance;
      column.v -= change;
      rows_[column.row].u += change;
    }
    std::int32_t column = end.column;
    if (column == none) column = std::exchange(rows_[end.row].column, none);
    while (column != none) {
      const std::int32_t row = columns_[column].predecessor;
      const std::int32_t given_up = rows_[row].column;
      match(row, column);
      column = given_up;
    }
    for (const std::int32_t touched : touched_) columns_[touched].distance = infinite;
  }

  /// Dijkstra over reduced costs. Afterwards `scanned_` holds the columns nearer than the end, `touched_` all columns
  /// with a distance.
  PathEnd shortest_path(std::int32_t start) {
    heap_.clear();
    scanned_.clear();
    touched_.clear();
    PathEnd end;
    std::int64_t here = 0;
    for (std::int32_t row = start;;) {
      scan(row, here, end);
      const std::int32_t column = nearest_column(end.distance);
      if (column == none) return end;
      here = columns_[column].distance;
      scanned_.push_back(column);
      row = columns_[column].row;
    }
  }

  void scan(std::int32_t row, std::int64_t here, PathEnd& end) {
    const std::int64_t offset = here - rows_[row].u;
    if (offset + threshold_ < end.distance) end = {offset + threshold_, none, row};
    for (const AssignmentRows::Entry& entry : entries_[row]) {
      if (offset + entry.cost >= end.distance) break;  // v <= 0: no further entry leads to a nearer column
      Column& column = columns_[entry.column];
      const std::int64_t distance = offset + entry.cost - column.v;
      if (distance >= end.distance || distance >= column.distance) continue;
      if (column.distance == infinite) touched_.push_back(entry.column);
      column.distance = distance;
      column.predecessor = row;
      if (column.row == none) {
        end = {distance, entry.column, none};
      } else {
        heap_.push_back({distance, entry.column});
        std::push_heap(heap_.begin(), heap_.end(), Farther{});
      }
    }
  }

  /// Takes the nearest column off the heap, if it is nearer than `limit`.
  std::int32_t nearest_column(std::int64_t limit) {
    while (!heap_.empty() && heap_.front().distance < limit) {
      const auto [distance, column] = heap_.front();
      std::pop_heap(heap_.begin(), heap_.end(), Farther{});
      heap_.pop_back();
      if (distance == columns_[column].distance) return column;  // else it was reached again on a shorter way
    }
    return none;
  }

  AssignmentRows entries_;
  std::int64_t threshold_;
  std::vector<Row> rows_;
  std::vector<Column> columns_;
  std::vector<Reached> heap_;
  std::vector<std::int32_t> scanned_, touched_;
};

/// The smaller side searches, since the larger one has nodes to spare: the other way round most searches run through
/// large parts of the graph before they find a row that had better give way.
bool should_transpose(std::size_t sources, std::size_t targets, std::span<const AssignmentEdge> edges) {
  std::vector<char> source_has_edge(sources, 0), target_has_edge(targets, 0);
  for (const AssignmentEdge& edge : edges) source_has_edge[edge.source] = target_has_edge[edge.target] = 1;
  return std::count(target_has_edge.begin(), target_has_edge.end(), 1) <
         std::count(source_has_edge.begin(), source_has_edge.end(), 1);
}

}  // namespace

Assignment solve_assignment(std::size_t sources, std::size_t targets, std::span<const AssignmentEdge> edges,
                            std::int64_t threshold) {
  check_assignment_problem(sources, targets, edges, threshold);
  const bool transpose = should_transpose(sources, targets, edges);
  Solver solver(transpose ? AssignmentRows(targets, transposed(targets, edges)) : AssignmentRows(sources, edges),
                transpose ? sources : targets, threshold);
  solver.solve();

  // Exchanging the sides exchanges threshold - u with -v: both are what a node gains by being matched.
  Assignment result;
  const auto add_source = [&](std::int32_t target, std::int64_t u) {
    result.target_of_source.push_back(target);
    result.source_potentials.push_back(u);
    result.matches += target != none;
    result.energy += u;
  };
  const auto add_target = [&](std::int64_t v) {
    result.target_potentials.push_back(v);
    result.energy += v;
  };
  if (transpose) {
    for (const Solver::Column& column : solver.columns()) add_source(column.row, threshold + column.v);
    for (const Solver::Row& row : solver.rows()) add_target(row.u - threshold);
  } else {
    for (const Solver::Row& row : solver.rows()) add_source(row.column, row.u);
    for (const Solver::Column& column : solver.columns()) add_target(column.v);
  }
  return result;
}

}  // namespace igsp

// SPDX-License-Identifier: Apache-2.0
#include "collection/earth_mover.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

namespace wellspring::collection {

namespace {

constexpr double never = 1e300;

// Four numbers side by side, in GCC's vector types as in base/simd.h.
typedef double Four __attribute__((vector_size(32)));
typedef int64_t FourWhole __attribute__((vector_size(32)));

Four smaller(Four a, Four b) { return a < b ? a : b; }
double least_of(Four a) { return std::min(std::min(a[0], a[1]), std::min(a[2], a[3])); }

// Moves the masses of rows to columns. Prices keep `cost - row_price - column_price` from being
// negative, and masses move only where that is 0. Columns up to Stride that are no points cost
// `never`. Sets of rows and columns are bits.
template <int Stride>
struct Transport {
  static_assert(Stride % 4 == 0);
  static constexpr size_t most = most_points, stride = Stride, fours = stride / 4;
  // Numbers of all columns, one by one and four by four.
  union Row {
    std::array<Four, fours> four;
    std::array<double, stride> one;
    double& operator[](size_t k) { return one[k]; }
    double operator[](size_t k) const { return one[k]; }
    void fill(double value) { one.fill(value); }
  };
  size_t rows = 0, columns = 0;
  std::array<Row, most> cost, moved;
  Row column_price, demand;
  std::array<double, most> row_price, supply;
  std::array<uint32_t, stride> movers;  // rows that move something to each column
  uint32_t full = 0;                    // rows that have something left

  void set_costs(const SetView& a, const SetView& b, int dims);
  void begin();
  void move_along_cheapest();
  double dual(const SetView& a, const SetView& b) const;
  double work() const;
};

template <int Stride>
void Transport<Stride>::set_costs(const SetView& a, const SetView& b, int dims) {
  rows = size_t(a.count), columns = size_t(b.count);
  for (size_t i = 0; i < rows; i++) {
    Row sum;
    sum.fill(0);
    for (int d = 0; d < dims; d++) {
      const double at = double(a.rows[size_t(d * a.stride) + i]);
      const float* to = b.rows + d * b.stride;
      for (size_t k = 0; k < stride; k++) {
        const double off = at - double(to[k]);
        sum[k] += off * off;
      }
    }
    for (size_t k = 0; k < stride; k++) cost[i][k] = std::sqrt(sum[k]);
    for (size_t k = columns; k < stride; k++) cost[i][k] = never;
    supply[i] = a.masses[i];
    moved[i].fill(0);
  }
  demand.fill(0), movers.fill(0);
  for (size_t k = 0; k < columns; k++) demand[k] = b.masses[k];
}

// Takes the cheapest way to every column, then from every row, as first prices, and moves what
// these allow.
template <int Stride>
void Transport<Stride>::begin() {
  column_price = cost[0];
  for (size_t i = 1; i < rows; i++)
    for (size_t f = 0; f < fours; f++)
      column_price.four[f] = smaller(column_price.four[f], cost[i].four[f]);
  for (size_t k = columns; k < stride; k++) column_price[k] = 0;
  full = 0;
  for (size_t i = 0; i < rows; i++) {
    Four four = cost[i].four[0] - column_price.four[0];
    for (size_t f = 1; f < fours; f++) four = smaller(four, cost[i].four[f] - column_price.four[f]);
    const double least = row_price[i] = least_of(four);
    for (size_t k = 0; k < columns; k++) {
      if (supply[i] == 0 || demand[k] == 0 || cost[i][k] - column_price[k] > least) continue;
      moved[i][k] = std::min(supply[i], demand[k]);
      supply[i] -= moved[i][k];
      demand[k] -= moved[i][k];
      movers[k] |= 1u << i;
    }
    if (supply[i] > 0) full |= 1u << i;
  }
}

// Finds the cheapest way from any row that has mass left to a column that wants some (Dijkstra over
// prices, backwards where masses move already), and moves as much as all parts of it allow.
template <int Stride>
void Transport<Stride>::move_along_cheapest() {
  Row way, closed;                      // to each column; infinite where it was looked at
  std::array<FourWhole, fours> from{};  // the row before each column
  std::array<int, most> through;        // the column before each row; -1: the row is a beginning
  std::array<double, most> row_way;
  Row column_way;
  uint32_t reached = 0, looked = 0;
  way.fill(never), closed.fill(0);
  auto before = [&](size_t k) { return size_t(from[k / 4][k % 4]); };
  auto reach = [&](size_t row, double length) {
    row_way[row] = length;
    reached |= 1u << row;
    const Row& costs = cost[row];
    const double offset = length - row_price[row];
    for (size_t f = 0; f < fours; f++) {
      const Four other = costs.four[f] - column_price.four[f] + offset + closed.four[f];
      from[f] = other < way.four[f] ? FourWhole{} + int64_t(row) : from[f];
      way.four[f] = smaller(other, way.four[f]);
    }
  };
  for (uint32_t left = full & (~full + 1); left; left &= left - 1) {
    through[size_t(std::countr_zero(left))] = -1;
    reach(size_t(std::countr_zero(left)), 0);
  }
  size_t column = 0;
  double length = 0;
  while (true) {
    Four least = way.four[0];
    FourWhole place = {0, 1, 2, 3};
    for (size_t f = 1; f < fours; f++) {
      place = way.four[f] < least ? FourWhole{0, 1, 2, 3} + int64_t(4 * f) : place;
      least = smaller(way.four[f], least);
    }
    length = least_of(least);
    const FourWhole there = least == length ? place : FourWhole{} + int64_t(stride);
    column = size_t(std::min(std::min(there[0], there[1]), std::min(there[2], there[3])));
    if (demand[column] > 0 || length == never) break;
    closed[column] = INFINITY, way[column] = never;
    column_way[column] = length;
    looked |= 1u << column;
    for (uint32_t next = movers[column] & ~reached; next; next &= next - 1) {
      const size_t row = size_t(std::countr_zero(next));
      through[row] = int(column);
      reach(row, length);
    }
  }
  for (uint32_t left = reached; left; left &= left - 1) {
    const size_t row = size_t(std::countr_zero(left));
    row_price[row] += length - row_way[row];
  }
  for (uint32_t left = looked; left; left &= left - 1) {
    const size_t k = size_t(std::countr_zero(left));
    column_price[k] -= length - column_way[k];
  }
  double amount = demand[column];
  size_t row = before(column);
  for (; through[row] >= 0; row = before(size_t(through[row])))
    amount = std::min(amount, moved[row][size_t(through[row])]);
  amount = std::min(amount, supply[row]);
  demand[column] -= amount;
  supply[row] -= amount;
  if (supply[row] == 0) full &= ~(1u << row);
  for (size_t to = column;;) {
    row = before(to);
    moved[row][to] += amount;
    movers[to] |= 1u << row;
    if (through[row] < 0) break;
    to = size_t(through[row]);
    moved[row][to] -= amount;
    if (moved[row][to] == 0) movers[to] &= ~(1u << row);
  }
}

template <int Stride>
double Transport<Stride>::dual(const SetView& a, const SetView& b) const {
  double sum = 0;
  for (size_t i = 0; i < rows; i++) sum += a.masses[i] * row_price[i];
  for (size_t k = 0; k < columns; k++) sum += b.masses[k] * column_price[k];
  return sum;
}

template <int Stride>
double Transport<Stride>::work() const {
  Four sum{};
  for (size_t i = 0; i < rows; i++)
    for (size_t f = 0; f < fours; f++) sum += moved[i].four[f] * cost[i].four[f];
  return sum[0] + sum[1] + sum[2] + sum[3];
}

template <int Stride>
double transport(const SetView& a, const SetView& b, int dims, double enough) {
  Transport<Stride> transport;
  transport.set_costs(a, b, dims);
  if (a.count == 1) {
    double sum = 0;
    for (size_t k = 0; k < size_t(b.count); k++) sum += b.masses[k] * transport.cost[0][k];
    return sum;
  }
  transport.begin();
  // Rounding must not take for farther what is as far.
  const double farther = enough + 1e-9 * (1 + enough);
  while (true) {
    if (enough < never)
      if (const double least = transport.dual(a, b); least > farther) return least;
    if (transport.full == 0) return transport.work();
    transport.move_along_cheapest();
  }
}

}  // namespace

double earth_mover(const SetView& a, const SetView& b, int dims, double enough) {
  if (a.count > b.count) return earth_mover(b, a, dims, enough);  // long rows suit vectors
  if (b.stride <= 4) return transport<4>(a, b, dims, enough);
  if (b.stride <= 8) return transport<8>(a, b, dims, enough);
  return transport<most_points>(a, b, dims, enough);
}

double mean_distance(const SetView& a, const SetView& b, int dims) {
  double sum = 0;
  for (int d = 0; d < dims; d++) sum += (a.mean[d] - b.mean[d]) * (a.mean[d] - b.mean[d]);
  return std::sqrt(sum);
}

}  // namespace wellspring::collection

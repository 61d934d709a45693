// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <bit>
#include <utility>

#include <scifi/core/linalg.hpp>
#include <scifi/kalman/column.hpp>
#include <scifi/kalman/structure.hpp>

/// Products of small matrices of a size known at compile time, by columns of the left one weighted with entries of the right one.
/// The results are written where they are to stay: a matrix copied right after it was written holds up the processor.
namespace scifi::kalman::detail {

/// Column Col of out = row Col of a, put together in a register: one written entry by entry would hold up the load that follows.
template <int Col, class Scalar, int Rows, int Cols, int... Entry>
[[gnu::always_inline]] inline void set_column_to_row(matrix<Scalar, Cols, Rows>& out, const matrix<Scalar, Rows, Cols>& a, std::integer_sequence<int, Entry...>) {
  column<Scalar, Cols> c;
  (c.template set<Entry>(a(Col, Entry)), ...);
  c.store(out.data() + Cols * Col);
}

template <class Scalar, int Rows, int Cols, int... Col>
[[gnu::always_inline]] inline void set_columns_to_rows(matrix<Scalar, Cols, Rows>& out, const matrix<Scalar, Rows, Cols>& a, std::integer_sequence<int, Col...>) {
  (set_column_to_row<Col>(out, a, std::make_integer_sequence<int, Cols>{}), ...);
}

/// The transpose as a matrix of its own (g++ 12 takes Eigen's check for aliasing in the constructor for a use before initialisation).
template <class Scalar, int Rows, int Cols>
[[nodiscard]] matrix<Scalar, Cols, Rows> transposed(const matrix<Scalar, Rows, Cols>& a) {
  matrix<Scalar, Cols, Rows> out;
  if constexpr (in_registers<Scalar> && Rows * Cols <= 81) {
    set_columns_to_rows(out, a, std::make_integer_sequence<int, Rows>{});
  } else {
    for (int j = 0; j < Cols; ++j)
      for (int i = 0; i < Rows; ++i) out(j, i) = a(i, j);
  }
  return out;
}

/// out = a, in the pieces in which columns are read later.
template <class Scalar, int Rows, int Cols>
[[gnu::always_inline]] inline void copy_columns(matrix<Scalar, Rows, Cols>& out, const matrix<Scalar, Rows, Cols>& a) {
  if constexpr (in_registers<Scalar>) {
    for (int j = 0; j < Cols; ++j) column<Scalar, Rows>::load(a.data() + Rows * j).store(out.data() + Rows * j);
  } else {
    out = a;
  }
}

/// out = sum over k of weight(k) times column k of a, over the k whose bit is set in Used, in two halves that do not wait for each other.
/// `out` may be a column of a matrix.
template <int Rows, int K, unsigned Used = ~0u, class Scalar, class Weight>
[[gnu::always_inline]] inline void combine_columns(Scalar* out, const Scalar* a, const Weight& weight) {
  constexpr int first = std::countr_zero(Used);
  static_assert(first < K);
  if constexpr (in_registers<Scalar>) {
    using column = detail::column<Scalar, Rows>;
    column sum = column::load(a + Rows * first).times(weight(first));
    constexpr unsigned others = Used & ((K < 32 ? 1u << (K % 32) : 0u) - 1u) & ~(1u << first);
    if constexpr (others != 0) {
      constexpr int second = std::countr_zero(others);
      column other = column::load(a + Rows * second).times(weight(second));
      bool even = true;
      for (int k = second + 1; k < K; ++k) {
        if (!has_bit(Used, k)) continue;
        if (even) sum.add(column::load(a + Rows * k), weight(k));
        else other.add(column::load(a + Rows * k), weight(k));
        even = !even;
      }
      sum.add(other);
    }
    sum.store(out);
  } else {
    for (int i = 0; i < Rows; ++i) {
      Scalar sum = a[i + Rows * first] * weight(first);
      for (int k = first + 1; k < K; ++k)
        if (has_bit(Used, k)) sum += a[i + Rows * k] * weight(k);
      out[i] = sum;
    }
  }
}

/// a x.
template <class Scalar, int Rows, int K, unsigned Used = ~0u>
[[nodiscard, gnu::always_inline]] inline vector<Scalar, Rows> times_vector(const matrix<Scalar, Rows, K>& a, const vector<Scalar, K>& x) {
  vector<Scalar, Rows> out;
  combine_columns<Rows, K, Used>(out.data(), a.data(), [&x](int k) -> const Scalar& { return x(k); });
  return out;
}

/// start + sum over k of a(k) b(k) over the k whose bit is set in Used, in two halves likewise.
template <int K, unsigned Used = ~0u, class Scalar, class A, class B>
[[nodiscard, gnu::always_inline]] inline Scalar add_dot(const Scalar& start, const A& a, const B& b) {
  Scalar sum(start);
  Scalar other(0.0);
  bool even = true;
  for (int k = 0; k < K; ++k) {
    if (!has_bit(Used, k)) continue;
    if (even) sum += a(k) * b(k);
    else other += a(k) * b(k);
    even = !even;
  }
  return sum + other;
}

/// out = base + a w.
template <class Scalar, int Rows, int K>
[[gnu::always_inline]] inline void set_vector_sum(vector<Scalar, Rows>& out, const vector<Scalar, Rows>& base, const matrix<Scalar, Rows, K>& a, const vector<Scalar, K>& w) {
  if constexpr (in_registers<Scalar>) {
    using column = detail::column<Scalar, Rows>;
    column sum = column::load(base.data());
    for (int k = 0; k < K; ++k) sum.add(column::load(a.data() + Rows * k), w(k));
    sum.store(out.data());
  } else {
    for (int i = 0; i < Rows; ++i) {
      Scalar sum(base(i));
      for (int k = 0; k < K; ++k) sum += a(i, k) * w(k);
      out(i) = sum;
    }
  }
}

/// out = a w, where weight(k, j) is the entry of w (K x Cols), over the columns k of a whose bit is set in Used.
template <unsigned Used = ~0u, class Scalar, int Rows, int K, int Cols, class Weight>
[[gnu::always_inline]] inline void multiply(matrix<Scalar, Rows, Cols>& out, const matrix<Scalar, Rows, K>& a, const Weight& weight) {
  if constexpr (in_registers<Scalar> && Cols > 3 && Used == ~0u) {
    using column = detail::column<Scalar, Rows>;
    for (int j = 0; j < Cols; ++j) {
      column sum = column::load(a.data()).times(weight(0, j));
      for (int k = 1; k < K; ++k) sum.add(column::load(a.data() + Rows * k), weight(k, j));
      sum.store(out.data() + Rows * j);
    }
  } else {
    for (int j = 0; j < Cols; ++j) combine_columns<Rows, K, Used>(out.data() + Rows * j, a.data(), [&weight, j](int k) -> decltype(auto) { return weight(k, j); });
  }
}

/// out = base - a w, where weight(k, j) is the entry of w (K x Cols).
template <class Scalar, int Rows, int K, int Cols, class Weight>
[[gnu::always_inline]] inline void set_difference(matrix<Scalar, Rows, Cols>& out, const matrix<Scalar, Rows, Cols>& base, const matrix<Scalar, Rows, K>& a, const Weight& weight) {
  if constexpr (in_registers<Scalar>) {
    using column = detail::column<Scalar, Rows>;
    for (int j = 0; j < Cols; ++j) {
      column sum = column::load(base.data() + Rows * j);
      for (int k = 0; k < K; ++k) sum.subtract(column::load(a.data() + Rows * k), weight(k, j));
      sum.store(out.data() + Rows * j);
    }
  } else {
    for (int j = 0; j < Cols; ++j) {
      for (int i = 0; i < Rows; ++i) {
        Scalar sum(base(i, j));
        for (int k = 0; k < K; ++k) sum -= a(i, k) * weight(k, j);
        out(i, j) = sum;
      }
    }
  }
}

/// a b.
template <class Scalar, int Rows, int K, int Cols>
[[nodiscard, gnu::always_inline]] inline matrix<Scalar, Rows, Cols> times(const matrix<Scalar, Rows, K>& a, const matrix<Scalar, K, Cols>& b) {
  matrix<Scalar, Rows, Cols> out;
  multiply(out, a, [&b](int k, int j) -> const Scalar& { return b(k, j); });
  return out;
}

/// a b'.
template <class Scalar, int Rows, int K, int Cols>
[[nodiscard, gnu::always_inline]] inline matrix<Scalar, Rows, Cols> times_transposed(const matrix<Scalar, Rows, K>& a, const matrix<Scalar, Cols, K>& b) {
  matrix<Scalar, Rows, Cols> out;
  multiply(out, a, [&b](int k, int j) -> const Scalar& { return b(j, k); });
  return out;
}

/// Column `to` of m less weight times column `from`.
template <class Scalar, int Rows, int Cols>
[[gnu::always_inline]] inline void subtract_column(matrix<Scalar, Rows, Cols>& m, int from, int to, const Scalar& weight) {
  if constexpr (in_registers<Scalar>) {
    using column = detail::column<Scalar, Rows>;
    column changed = column::load(m.data() + Rows * to);
    changed.subtract(column::load(m.data() + Rows * from), weight);
    changed.store(m.data() + Rows * to);
  } else {
    for (int i = 0; i < Rows; ++i) m(i, to) -= m(i, from) * weight;
  }
}

/// Column j of out = column j of a times a number; out may be a.
template <class Scalar, int Rows, int Cols>
[[gnu::always_inline]] inline void set_scaled_column(matrix<Scalar, Rows, Cols>& out, const matrix<Scalar, Rows, Cols>& a, int j, const Scalar& factor) {
  if constexpr (in_registers<Scalar>) {
    column<Scalar, Rows>::load(a.data() + Rows * j).times(factor).store(out.data() + Rows * j);
  } else {
    for (int i = 0; i < Rows; ++i) out(i, j) = a(i, j) * factor;
  }
}

}  // namespace scifi::kalman::detail

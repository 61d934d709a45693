// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <utility>

#include <scifi/core/linalg.hpp>
#include <scifi/kalman/product.hpp>

namespace scifi::kalman::detail {

/// Column Col of m with the entries below the diagonal taken from row Col.
template <int Col, class Scalar, int N, int... Row>
[[gnu::always_inline]] inline void mirror_column(matrix<Scalar, N, N>& m, std::integer_sequence<int, Row...>) {
  auto c = column<Scalar, N>::load(m.data() + N * Col);
  (c.template set<(Col + 1 + Row)>(m(Col, Col + 1 + Row)), ...);
  c.store(m.data() + N * Col);
}

template <class Scalar, int N, int... Col>
[[gnu::always_inline]] inline void mirror_columns(matrix<Scalar, N, N>& m, std::integer_sequence<int, Col...>) {
  (mirror_column<Col, Scalar, N>(m, std::make_integer_sequence<int, N - 1 - Col>{}), ...);
}

/// Copies the upper triangle to the lower one.
template <class Scalar, int N>
[[gnu::always_inline]] inline void mirror(matrix<Scalar, N, N>& m) {
  constexpr int most_unrolled = 9;
  if constexpr (in_registers<Scalar> && N <= most_unrolled) {
    // Whole columns are put together in registers: one written entry by entry would hold up the load that follows.
    mirror_columns<Scalar, N>(m, std::make_integer_sequence<int, N - 1>{});
  } else {
    for (int j = 1; j < N; ++j)
      for (int i = 0; i < j; ++i) m(j, i) = m(i, j);
  }
}

/// Columns From and on of out = base + a w (or base - a w), weight(k, j) the entry of w (K x N), down to the end of the register that holds the diagonal.
template <bool Minus, int From, class Scalar, int N, int K, class Weight>
[[gnu::always_inline]] inline void add_product(matrix<Scalar, N, N>& out, const matrix<Scalar, N, N>& base, const matrix<Scalar, N, K>& a, const Weight& weight) {
  if constexpr (in_registers<Scalar>) {
    if constexpr (From < N) {
      constexpr int end = registers_through<Scalar, N>(From);
      for (int j = From; j < end; ++j) {
        auto sum = column<Scalar, end>::load(base.data() + N * j);
        for (int k = 0; k < K; ++k) {
          const auto c = column<Scalar, N>::load(a.data() + N * k);
          if constexpr (Minus) sum.subtract(c, weight(k, j));
          else sum.add(c, weight(k, j));
        }
        sum.store(out.data() + N * j);
      }
      add_product<Minus, end>(out, base, a, weight);
    }
  } else {
    for (int j = 0; j < N; ++j) {
      for (int i = 0; i <= j; ++i) {
        Scalar sum(base(i, j));
        for (int k = 0; k < K; ++k) {
          if constexpr (Minus) sum -= a(i, k) * weight(k, j);
          else sum += a(i, k) * weight(k, j);
        }
        out(i, j) = sum;
      }
    }
  }
}

/// out = base + a w, known to be symmetric: the upper triangle is computed and copied, so it is symmetric to the last bit.
template <class Scalar, int N, int K, class Weight>
[[gnu::always_inline]] inline void set_symmetric_sum(matrix<Scalar, N, N>& out, const matrix<Scalar, N, N>& base, const matrix<Scalar, N, K>& a, const Weight& weight) {
  add_product<false, 0>(out, base, a, weight);
  mirror<Scalar, N>(out);
}

/// out = base - a w, likewise.
template <class Scalar, int N, int K, class Weight>
[[gnu::always_inline]] inline void set_symmetric_difference(matrix<Scalar, N, N>& out, const matrix<Scalar, N, N>& base, const matrix<Scalar, N, K>& a, const Weight& weight) {
  add_product<true, 0>(out, base, a, weight);
  mirror<Scalar, N>(out);
}

/// out = base - sum over k of z_k z_k' d_k for symmetric base, all entries; product by product, so that it is symmetric to the last bit as base is.
template <class Scalar, int N, int K>
[[gnu::always_inline]] inline void subtract_squares(matrix<Scalar, N, N>& out, const matrix<Scalar, N, N>& base, const matrix<Scalar, N, K>& z, const vector<Scalar, K>& d) {
  if constexpr (in_registers<Scalar>) {
    using column = detail::column<Scalar, N>;
    for (int j = 0; j < N; ++j) {
      column sum = column::load(base.data() + N * j);
      for (int k = 0; k < K; ++k) sum.subtract(column::load(z.data() + N * k).times(z(j, k)), d(k));
      sum.store(out.data() + N * j);
    }
  } else {
    for (int j = 0; j < N; ++j) {
      for (int i = 0; i <= j; ++i) {
        Scalar sum(base(i, j));
        for (int k = 0; k < K; ++k) {
          const Scalar square = z(i, k) * z(j, k);
          sum -= square * d(k);
        }
        out(i, j) = sum;
        out(j, i) = sum;
      }
    }
  }
}

/// b' as the weights of a product.
template <class Scalar, int N, int K>
[[nodiscard, gnu::always_inline]] inline auto transpose_of(const matrix<Scalar, N, K>& b) {
  return [&b](int k, int j) -> const Scalar& { return b(j, k); };
}

/// base + a b', likewise.
template <class Scalar, int N, int K>
[[nodiscard]] matrix<Scalar, N, N> symmetric_sum(const matrix<Scalar, N, N>& base, const matrix<Scalar, N, K>& a, const matrix<Scalar, N, K>& b) {
  matrix<Scalar, N, N> out;
  set_symmetric_sum(out, base, a, transpose_of<Scalar, N, K>(b));
  return out;
}

/// out = f p f' + added, with p and `added` symmetric; symmetric to the last bit.
template <class Scalar, int N, int K>
[[gnu::always_inline]] inline void set_similarity(matrix<Scalar, N, N>& out, const matrix<Scalar, N, K>& f, const matrix<Scalar, K, K>& p, const matrix<Scalar, N, N>& added) {
  const matrix<Scalar, N, K> fp = times<Scalar, N, K, K>(f, p);
  set_symmetric_sum(out, added, fp, transpose_of<Scalar, N, K>(f));
}

/// f p f' + added.
template <class Scalar, int N, int K>
[[nodiscard]] matrix<Scalar, N, N> similarity(const matrix<Scalar, N, K>& f, const matrix<Scalar, K, K>& p, const matrix<Scalar, N, N>& added) {
  matrix<Scalar, N, N> out;
  set_similarity<Scalar, N, K>(out, f, p, added);
  return out;
}

/// f p f', symmetric to the last bit.
template <class Scalar, int N, int K>
[[nodiscard]] matrix<Scalar, N, N> similarity(const matrix<Scalar, N, K>& f, const matrix<Scalar, K, K>& p) {
  return similarity<Scalar, N, K>(f, p, matrix<Scalar, N, N>::Zero());
}

}  // namespace scifi::kalman::detail

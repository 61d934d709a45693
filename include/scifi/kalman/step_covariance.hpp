// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/core/linalg.hpp>
#include <scifi/kalman/structure.hpp>
#include <scifi/kalman/symmetric.hpp>

namespace scifi::kalman::detail {

/// Columns From and on of out = base + a f' over the columns of f that are not unit vectors, and column j of a itself where column j of f is one.
template <unsigned Unit, int From, class Scalar, int N>
[[gnu::always_inline]] inline void add_carried(matrix<Scalar, N, N>& out, const matrix<Scalar, N, N>& base, const matrix<Scalar, N, N>& a, const matrix<Scalar, N, N>& f) {
  if constexpr (From < N) {
    constexpr int end = registers_through<Scalar, N>(From);
    for (int j = From; j < end; ++j) {
      auto sum = column<Scalar, end>::load(base.data() + N * j);
      if (has_bit(Unit, j)) sum.add(column<Scalar, end>::load(a.data() + N * j));
      for (int k = 0; k < N; ++k)
        if (!has_bit(Unit, k)) sum.add(column<Scalar, N>::load(a.data() + N * k), f(j, k));
      sum.store(out.data() + N * j);
    }
    add_carried<Unit, end>(out, base, a, f);
  }
}

/// out = f p f' + added for symmetric p and `added`, where the columns of f with a bit in Unit are those of the identity; symmetric to the last bit.
template <unsigned Unit, class Scalar, int N>
[[gnu::always_inline]] inline void carry_covariance(matrix<Scalar, N, N>& out, const matrix<Scalar, N, N>& f, const matrix<Scalar, N, N>& p, const matrix<Scalar, N, N>& added) {
  if constexpr (Unit == 0) {
    set_similarity<Scalar, N, N>(out, f, p, added);
  } else {
    matrix<Scalar, N, N> fp;
    if constexpr (in_registers<Scalar>) {
      using column = detail::column<Scalar, N>;
      for (int j = 0; j < N; ++j) {
        column sum = column::load(p.data() + N * j).template only<Unit>();
        for (int k = 0; k < N; ++k)
          if (!has_bit(Unit, k)) sum.add(column::load(f.data() + N * k), p(k, j));
        sum.store(fp.data() + N * j);
      }
      add_carried<Unit, 0>(out, added, fp, f);
    } else {
      for (int j = 0; j < N; ++j) {
        for (int i = 0; i < N; ++i) {
          Scalar sum(0.0);
          if (has_bit(Unit, i)) sum = p(i, j);
          for (int k = 0; k < N; ++k)
            if (!has_bit(Unit, k)) sum += f(i, k) * p(k, j);
          fp(i, j) = sum;
        }
      }
      for (int j = 0; j < N; ++j) {
        for (int i = 0; i <= j; ++i) {
          Scalar sum(added(i, j));
          if (has_bit(Unit, j)) sum += fp(i, j);
          for (int k = 0; k < N; ++k)
            if (!has_bit(Unit, k)) sum += fp(i, k) * f(j, k);
          out(i, j) = sum;
        }
      }
    }
    mirror<Scalar, N>(out);
  }
}

}  // namespace scifi::kalman::detail

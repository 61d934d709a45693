// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <type_traits>

#include <scifi/core/linalg.hpp>

namespace scifi::kalman {

namespace detail {

template <class T>
concept eigen_like = requires {
  typename T::Scalar;
  T::RowsAtCompileTime;
  T::ColsAtCompileTime;
};

template <class T>
consteval int rows_of() {
  using type = std::remove_cvref_t<T>;
  if constexpr (eigen_like<type>) return type::RowsAtCompileTime;
  else return 1;
}

template <class T>
consteval int cols_of() {
  using type = std::remove_cvref_t<T>;
  if constexpr (eigen_like<type>) return type::ColsAtCompileTime;
  else return 1;
}

/// A Rows x Cols fixed-size matrix, or a plain number where both are 1.
template <class T, int Rows, int Cols>
concept shaped = rows_of<T>() == Rows && cols_of<T>() == Cols && Rows > 0 && Cols > 0;

/// True for fixed-size Eigen types and plain numbers.
template <class T>
concept fixed_size = rows_of<T>() > 0 && cols_of<T>() > 0;

/// The value as a matrix of the wanted scalar; a plain number becomes 1 x 1.
template <class Scalar, int Rows, int Cols, class T>
[[nodiscard]] matrix<Scalar, Rows, Cols> as_matrix(const T& value) {
  if constexpr (eigen_like<T>) {
    if constexpr (std::is_same_v<typename T::Scalar, Scalar>) return value;
    else return value.template cast<Scalar>();
  } else {
    return matrix<Scalar, Rows, Cols>::Constant(Scalar(value));
  }
}

/// What f() returns as a matrix of the wanted scalar, to be bound to a constant reference: without a copy where f() makes it or refers to one.
template <class Scalar, int Rows, int Cols, class F>
[[nodiscard]] decltype(auto) converted(const F& f) {
  using wanted = matrix<Scalar, Rows, Cols>;
  if constexpr (std::is_same_v<decltype(f()), wanted> || std::is_same_v<decltype(f()), const wanted&>) return f();
  else return as_matrix<Scalar, Rows, Cols>(f());
}

}  // namespace detail

/// Rows x Cols numbers on the stack, where either may be Eigen::Dynamic up to a maximum known at compile time: never on the heap.
template <class Scalar, int Rows, int Cols, int MaxRows, int MaxCols>
using bounded_matrix = Eigen::Matrix<Scalar, Rows, Cols, (MaxRows == 1 && MaxCols != 1) ? Eigen::RowMajor : Eigen::ColMajor, MaxRows, MaxCols>;

}  // namespace scifi::kalman

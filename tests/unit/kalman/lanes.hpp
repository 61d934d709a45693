// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <Eigen/Core>

#include <array>
#include <cmath>

// A pack of four numbers in plain C++: what a SIMD type must offer for one track a lane, and nothing more.
namespace lanes {

struct mask {
  std::array<bool, 4> b{};
  friend mask operator!(mask m) {
    for (bool& x : m.b) x = !x;
    return m;
  }
  friend mask operator&&(mask m, const mask& n) {
    for (std::size_t i = 0; i < 4; ++i) m.b[i] = m.b[i] && n.b[i];
    return m;
  }
};

struct pack {
  std::array<double, 4> v{};
  pack() = default;
  pack(double x) { v.fill(x); }  // implicit: constants of a model are numbers
  pack(double a, double b, double c, double d) : v{a, b, c, d} {}

  template <class F>
  friend pack each(const pack& a, const pack& b, F f) {
    pack out;
    for (std::size_t i = 0; i < 4; ++i) out.v[i] = f(a.v[i], b.v[i]);
    return out;
  }
  template <class F>
  friend mask test(const pack& a, const pack& b, F f) {
    mask out;
    for (std::size_t i = 0; i < 4; ++i) out.b[i] = f(a.v[i], b.v[i]);
    return out;
  }
  friend pack operator+(const pack& a, const pack& b) { return each(a, b, [](double x, double y) { return x + y; }); }
  friend pack operator-(const pack& a, const pack& b) { return each(a, b, [](double x, double y) { return x - y; }); }
  friend pack operator*(const pack& a, const pack& b) { return each(a, b, [](double x, double y) { return x * y; }); }
  friend pack operator/(const pack& a, const pack& b) { return each(a, b, [](double x, double y) { return x / y; }); }
  friend pack operator-(const pack& a) { return pack(0.0) - a; }
  pack& operator+=(const pack& b) { return *this = *this + b; }
  pack& operator-=(const pack& b) { return *this = *this - b; }
  pack& operator*=(const pack& b) { return *this = *this * b; }
  pack& operator/=(const pack& b) { return *this = *this / b; }
  friend mask operator<(const pack& a, const pack& b) { return test(a, b, [](double x, double y) { return x < y; }); }
  friend mask operator>(const pack& a, const pack& b) { return test(a, b, [](double x, double y) { return x > y; }); }
  friend mask operator<=(const pack& a, const pack& b) { return test(a, b, [](double x, double y) { return x <= y; }); }
  friend mask operator>=(const pack& a, const pack& b) { return test(a, b, [](double x, double y) { return x >= y; }); }
  friend pack sqrt(const pack& a) { return each(a, a, [](double x, double) { return std::sqrt(x); }); }
};

inline pack select(const mask& m, const pack& a, const pack& b) {
  pack out;
  for (std::size_t i = 0; i < 4; ++i) out.v[i] = m.b[i] ? a.v[i] : b.v[i];
  return out;
}
inline bool any_of(const mask& m) { return m.b[0] || m.b[1] || m.b[2] || m.b[3]; }
inline bool all_of(const mask& m) { return m.b[0] && m.b[1] && m.b[2] && m.b[3]; }

}  // namespace lanes

template <>
struct Eigen::NumTraits<lanes::pack> : Eigen::GenericNumTraits<double> {
  using Real = lanes::pack;
  using NonInteger = lanes::pack;
  using Literal = double;
  using Nested = lanes::pack;
};

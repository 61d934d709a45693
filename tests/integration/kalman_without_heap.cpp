// SPDX-License-Identifier: MPL-2.0
// A run over measurements of mixed dimension asks the heap for nothing: neither through operator new nor through Eigen.
#include <cstdlib>
#include <new>

namespace {
long news = 0;
long eigen_complaints = 0;
}  // namespace

// Eigen reports an allocation, while they are forbidden, through its assertion, in release builds too.
#define EIGEN_RUNTIME_NO_MALLOC
#define eigen_assert(condition) static_cast<void>((condition) ? 0 : ++eigen_complaints)
// After an assertion that goes on, GCC 12 sees a way on with an index below zero.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Warray-bounds"
#endif

#include "support/catch.hpp"

#include <array>
#include <optional>
#include <variant>

#include <scifi/kalman.hpp>

#include "unit/kalman/models.hpp"

void* operator new(std::size_t size) {
  ++news;
  if (void* const p = std::malloc(size == 0 ? 1 : size)) return p;
  throw std::bad_alloc{};
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }

namespace kalman = scifi::kalman;

namespace {

using two = models::linear_values<2, 2>;
using three = models::linear_values<2, 3>;
using any = std::variant<kalman::no_measurement, models::position, two, three>;

template <class Filter, class Start>
void check(const Filter& f, const Start& start) {
  const two pair{{1.0, 1.0}, Eigen::Matrix2d::Identity(), Eigen::Matrix2d::Identity()};
  const three triple{{1.0, 2.0, 3.0}, scifi::matrix<double, 3, 2>::Ones(), Eigen::Matrix3d::Identity()};
  const std::array<kalman::site<std::optional<double>, any>, 5> sites{
      {{kalman::at_start, models::position{0.1, 0.1}}, {1.0, pair}, {1.0, kalman::no_measurement{}}, {1.0, triple}, {1.0, models::position{4.0, 0.1}}}};
  std::array<kalman::node<double, 2, 3>, 5> nodes;
  std::array<Eigen::Vector2d, 6> references;
  references.fill(start.mean);

  Eigen::internal::set_is_malloc_allowed(false);
  const long before = news;
  const auto result = f.run(start, sites, nodes);
  const auto again = f.run(start, sites, nodes, references);
  const auto smoothed = kalman::smooth(nodes);
  double sum = 0.0;
  for (const auto& n : nodes)
    if (n.measurement_dimension > 0) sum += kalman::pull(kalman::unbiased_residual(n)) + kalman::whitened(kalman::filtered_residual(n))(0);
  const long after = news;
  Eigen::internal::set_is_malloc_allowed(true);

  CHECK(after == before);
  CHECK(eigen_complaints == 0);
  CHECK(result.status.ok());
  CHECK(again.ndf == 7);
  CHECK(smoothed.ok());
  CHECK(std::isfinite(sum));
}

}  // namespace

TEST_CASE("run, smoother and residuals leave the heap alone", "[kalman]") {
  const auto start = kalman::uncorrelated(Eigen::Vector2d(0.0, 1.0), Eigen::Vector2d(1.0, 1.0));
  check(kalman::filter{models::constant_velocity{}, models::white_acceleration{0.1}}, start);
  check(kalman::filter{models::constant_velocity{}, models::white_acceleration{0.1}, kalman::iterated{}, kalman::chi2_gate{1e6}}, start);
  check(kalman::filter{models::constant_velocity{}, models::white_acceleration{0.1}, kalman::square_root{}}, kalman::factored(start));
}

TEST_CASE("the two counters see what they are there for", "[kalman]") {
  const long before = news;
  ::operator delete(::operator new(1));  // a new-expression might be optimised away
  CHECK(news > before);
  Eigen::internal::set_is_malloc_allowed(false);
  const Eigen::MatrixXd heap = Eigen::MatrixXd::Zero(3, 3);
  Eigen::internal::set_is_malloc_allowed(true);
  CHECK(eigen_complaints > 0);
  CHECK(heap(0, 0) == 0.0);
  eigen_complaints = 0;
}

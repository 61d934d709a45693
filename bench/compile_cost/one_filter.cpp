// SPDX-License-Identifier: MPL-2.0
// Compile cost of one filter of five components and one measured value.
#include <scifi/kalman/filter.hpp>
#include <scifi/kalman/symmetric_form.hpp>

using square = scifi::matrix<double, 5, 5>;

struct model {
  square f, q;
  const square& transition(double) const { return f; }
  const square& covariance(double) const { return q; }
};

struct row {
  scifi::matrix<double, 1, 5> h;
  double z;
  double value() const { return z; }
  double covariance() const { return 1.5; }
  const scifi::matrix<double, 1, 5>& projection() const { return h; }
};

double step(const model& m, const row& seen, scifi::kalman::estimate<double, 5>& e);
double step(const model& m, const row& seen, scifi::kalman::estimate<double, 5>& e) {
  const scifi::kalman::filter filter{m, m, scifi::kalman::symmetric_form{}};
  const auto u = filter.update(filter.predict(e, 1.0), seen);
  e = u.posterior;
  return u.chi2;
}

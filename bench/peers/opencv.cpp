// SPDX-License-Identifier: MPL-2.0
// The filter step of bench/filter_step.cpp by OpenCV's KalmanFilter.
#include <opencv2/video/tracking.hpp>

#include "support/peer_main.hpp"

namespace {

template <int N, int M>
struct opencv {
  static constexpr bool has_chi2 = false;

  template <int Rows, int Cols>
  static cv::Mat given(const scifi::matrix<double, Rows, Cols>& m) {
    cv::Mat out(Rows, Cols, CV_64F);
    for (int i = 0; i < Rows; ++i)
      for (int j = 0; j < Cols; ++j) out.at<double>(i, j) = m(i, j);
    return out;
  }

  static stepping::answer<N> run(const stepping::problem<double, N, M>& g) {
    static cv::KalmanFilter filter = [&g] {
      cv::KalmanFilter f(N, M, 0, CV_64F);
      f.transitionMatrix = given(g.f);
      f.processNoiseCov = given(g.q);
      f.measurementMatrix = given(g.h);
      f.measurementNoiseCov = given(g.r);
      return f;
    }();
    static const std::vector<cv::Mat> measured = [&g] {
      std::vector<cv::Mat> all;
      for (const auto& z : g.z) all.push_back(given<M, 1>(z));
      return all;
    }();
    filter.statePost = cv::Mat::zeros(N, 1, CV_64F);
    filter.errorCovPost = cv::Mat::eye(N, N, CV_64F);
    for (const cv::Mat& z : measured) {
      filter.predict();
      filter.correct(z);
    }
    stepping::answer<N> out;
    for (int i = 0; i < N; ++i) {
      out.x(i) = filter.statePost.at<double>(i);
      for (int j = 0; j < N; ++j) out.p(i, j) = filter.errorCovPost.at<double>(i, j);
    }
    return out;
  }
};

}  // namespace

int main(int argc, char** argv) {
  cv::setNumThreads(1);
  return stepping::time_peer<opencv>("opencv", argc, argv);
}

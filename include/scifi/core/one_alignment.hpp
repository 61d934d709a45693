// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <Eigen/Core>
#include <type_traits>

namespace scifi::detail {

/// Stops the link of a program whose parts disagree on the alignment of Eigen's objects.
///
/// Eigen aligns fixed-size matrices to the widest vector register that the compiler flags allow: 16 bytes without flags on x86-64, 32 with -mavx, 64 with
/// -mavx512f. Two translation units with different flags then lay out the same struct differently, and exchange garbage or crash. What has to match is
/// EIGEN_MAX_STATIC_ALIGN_BYTES: give all parts the same flags, or define that macro to the same value (16 serves all of x86-64) for all of them.
///
/// How: this function is emitted by every translation unit, its argument makes the alignment a part of its name, and its body holds a symbol that is not
/// weak. Of functions of one name the linker keeps one, and all is well; of two names it keeps both, and reports the second definition of the symbol.
/// ELF only (Linux, BSD); elsewhere the rule holds and nothing checks it.
#if defined(__ELF__) && defined(__GNUC__)
[[gnu::used, gnu::noinline]] inline void one_alignment(std::integral_constant<int, EIGEN_MAX_STATIC_ALIGN_BYTES> /*bytes*/) {
  __asm__ volatile(
      ".globl scifi_error_define_EIGEN_MAX_STATIC_ALIGN_BYTES_alike_in_all_translation_units\n"
      "scifi_error_define_EIGEN_MAX_STATIC_ALIGN_BYTES_alike_in_all_translation_units:\n");
}
#endif

}  // namespace scifi::detail

// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <initializer_list>

namespace scifi {

/// A sequence of at most Capacity elements that lives inside its owner: no heap, trivially copyable when T is.
/// `push_back` on a full sequence returns false and leaves it unchanged; an index out of range, a list longer than Capacity and `pop_back` on none are bugs and assert.
template <class T, std::size_t Capacity>
class inline_vector {
 public:
  using value_type = T;
  constexpr inline_vector() = default;
  constexpr inline_vector(std::initializer_list<T> list) {
    assert(list.size() <= Capacity);
    for (const T& x : list) push_back(x);
  }
  constexpr bool push_back(const T& x) {
    if (size_ == Capacity) return false;
    items_[size_++] = x;
    return true;
  }
  constexpr void pop_back() {
    assert(size_ > 0);
    --size_;
  }
  constexpr void clear() { size_ = 0; }
  [[nodiscard]] constexpr std::size_t size() const { return size_; }
  [[nodiscard]] constexpr bool empty() const { return size_ == 0; }
  [[nodiscard]] static constexpr std::size_t capacity() { return Capacity; }
  [[nodiscard]] constexpr T& operator[](std::size_t i) {
    assert(i < size_);
    return items_[i];
  }
  [[nodiscard]] constexpr const T& operator[](std::size_t i) const {
    assert(i < size_);
    return items_[i];
  }
  [[nodiscard]] constexpr T& back() { return (*this)[size_ - 1]; }
  [[nodiscard]] constexpr const T& back() const { return (*this)[size_ - 1]; }
  [[nodiscard]] constexpr T* begin() { return items_.data(); }
  [[nodiscard]] constexpr T* end() { return items_.data() + size_; }
  [[nodiscard]] constexpr const T* begin() const { return items_.data(); }
  [[nodiscard]] constexpr const T* end() const { return items_.data() + size_; }

 private:
  std::array<T, Capacity> items_{};
  std::size_t size_ = 0;
};

}  // namespace scifi

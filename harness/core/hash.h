// Content hashes (XXH3, 128 bits): names of cache entries and points.
#pragma once
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace penumbra {

class Hasher {
 public:
  Hasher();
  ~Hasher();
  Hasher(const Hasher&) = delete;
  Hasher& operator=(const Hasher&) = delete;

  Hasher& bytes(const void* data, std::size_t size);
  // Length-prefixed, so that ("ab","c") and ("a","bc") differ.
  Hasher& text(std::string_view s);
  template <class T>
  Hasher& value(const T& v) {
    static_assert((std::is_trivially_copyable_v<T> && std::has_unique_object_representations_v<T>) ||
                  std::is_floating_point_v<T>);
    return bytes(&v, sizeof v);
  }
  template <class T>
  Hasher& array(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    value(values.size());
    return bytes(values.data(), values.size_bytes());
  }
  // 32 hexadecimal digits.
  std::string hex() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace penumbra

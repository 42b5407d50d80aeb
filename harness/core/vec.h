// Small vectors and matrices. Matrices are named target_from_source and stored by columns.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace penumbra {

template <class T>
struct Vec2 {
  T x{}, y{};
  bool operator==(const Vec2&) const = default;
};

template <class T>
struct Vec3 {
  T x{}, y{}, z{};
  T& operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
  const T& operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
  bool operator==(const Vec3&) const = default;
  template <class U>
  explicit operator Vec3<U>() const {
    return {static_cast<U>(x), static_cast<U>(y), static_cast<U>(z)};
  }
};

template <class T>
struct Vec4 {
  T x{}, y{}, z{}, w{};
  T& operator[](int i) { return i == 0 ? x : i == 1 ? y : i == 2 ? z : w; }
  const T& operator[](int i) const { return i == 0 ? x : i == 1 ? y : i == 2 ? z : w; }
  Vec3<T> xyz() const { return {x, y, z}; }
  bool operator==(const Vec4&) const = default;
};

using Vec2f = Vec2<float>;
using Vec3f = Vec3<float>;
using Vec4f = Vec4<float>;
using Vec2d = Vec2<double>;
using Vec3d = Vec3<double>;
using Vec4d = Vec4<double>;
using Vec2i = Vec2<int>;

// clang-format off
template <class T> constexpr Vec3<T> operator+(Vec3<T> a, Vec3<T> b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
template <class T> constexpr Vec3<T> operator-(Vec3<T> a, Vec3<T> b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
template <class T> constexpr Vec3<T> operator-(Vec3<T> a) { return {-a.x, -a.y, -a.z}; }
template <class T> constexpr Vec3<T> operator*(Vec3<T> a, T s) { return {a.x * s, a.y * s, a.z * s}; }
template <class T> constexpr Vec3<T> operator*(T s, Vec3<T> a) { return a * s; }
template <class T> constexpr Vec3<T> operator/(Vec3<T> a, T s) { return {a.x / s, a.y / s, a.z / s}; }
template <class T> constexpr Vec3<T>& operator+=(Vec3<T>& a, Vec3<T> b) { return a = a + b; }
template <class T> constexpr T dot(Vec3<T> a, Vec3<T> b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
template <class T> constexpr Vec3<T> cross(Vec3<T> a, Vec3<T> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T> T length(Vec3<T> a) { return std::sqrt(dot(a, a)); }
// Unit vector; the zero vector stays zero.
template <class T> Vec3<T> normalize(Vec3<T> a) {
  const T l = length(a);
  return l > T(0) ? a / l : a;
}
template <class T> Vec3<T> min(Vec3<T> a, Vec3<T> b) {
  return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
template <class T> Vec3<T> max(Vec3<T> a, Vec3<T> b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

// 4 x 4, column-major (as GLSL): m[column] is a Vec4.
template <class T>
struct Mat4 {
  Vec4<T> columns[4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
  Vec4<T>& operator[](int c) { return columns[c]; }
  const Vec4<T>& operator[](int c) const { return columns[c]; }
  bool operator==(const Mat4&) const = default;
};
using Mat4f = Mat4<float>;
using Mat4d = Mat4<double>;

template <class T> Vec4<T> operator*(const Mat4<T>& m, Vec4<T> v) {
  Vec4<T> r;
  for (int i = 0; i < 4; ++i) r[i] = m[0][i] * v.x + m[1][i] * v.y + m[2][i] * v.z + m[3][i] * v.w;
  return r;
}
template <class T> Mat4<T> operator*(const Mat4<T>& a, const Mat4<T>& b) {
  Mat4<T> r;
  for (int c = 0; c < 4; ++c) r[c] = a * b[c];
  return r;
}
template <class T> Vec3<T> transform_point(const Mat4<T>& m, Vec3<T> p) { return (m * Vec4<T>{p.x, p.y, p.z, 1}).xyz(); }
template <class T> Vec3<T> transform_vector(const Mat4<T>& m, Vec3<T> v) { return (m * Vec4<T>{v.x, v.y, v.z, 0}).xyz(); }

Mat4d translation(Vec3d t);
Mat4d scaling(Vec3d s);
// Rotation by `degrees` about a unit axis, right-handed.
Mat4d rotation(Vec3d axis, double degrees);
// General inverse; the matrix must not be singular.
Mat4d inverse(const Mat4d& m);
Mat4f to_float(const Mat4d& m);

// Axis-aligned box; default-constructed it is empty.
struct Box {
  Vec3f lo{INFINITY, INFINITY, INFINITY}, hi{-INFINITY, -INFINITY, -INFINITY};
  void extend(Vec3f p) { lo = min(lo, p), hi = max(hi, p); }
  bool empty() const { return !(lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z); }
  Vec3f center() const { return (lo + hi) * 0.5f; }
  float diagonal() const { return empty() ? 0.0f : length(hi - lo); }
};

}  // namespace penumbra

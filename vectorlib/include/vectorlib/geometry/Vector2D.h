#pragma once

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <vector>

namespace vectorlib {

/// A vector or a point in the plane; metres. The memory layout is that of an Eigen 2-vector.
template <typename Scalar = float>
struct Vector2D {
    Scalar x = 0;
    Scalar y = 0;

    constexpr Vector2D() = default;
    constexpr Vector2D(Scalar x_, Scalar y_)
        : x(x_)
        , y(y_) {}
    template <typename Other>
    constexpr explicit Vector2D(const Vector2D<Other> &other)
        : x(static_cast<Scalar>(other.x))
        , y(static_cast<Scalar>(other.y)) {}

    constexpr Vector2D operator+(Vector2D o) const { return {x + o.x, y + o.y}; }
    constexpr Vector2D operator-(Vector2D o) const { return {x - o.x, y - o.y}; }
    constexpr Vector2D operator-() const { return {-x, -y}; }
    constexpr Vector2D operator*(Scalar k) const { return {x * k, y * k}; }
    constexpr Vector2D operator/(Scalar k) const { return {x / k, y / k}; }
    constexpr Vector2D &operator+=(Vector2D o) { return *this = *this + o; }
    constexpr Vector2D &operator-=(Vector2D o) { return *this = *this - o; }
    constexpr bool operator==(Vector2D o) const { return x == o.x && y == o.y; }
    constexpr bool operator!=(Vector2D o) const { return !(*this == o); }

    constexpr Scalar dot(Vector2D o) const { return x * o.x + y * o.y; }
    /// The signed z component of the cross product (erratum 11): positive when o lies to the left.
    constexpr Scalar cross(Vector2D o) const { return x * o.y - y * o.x; }
    constexpr Scalar squaredNorm() const { return x * x + y * y; }
    Scalar norm() const { return std::sqrt(squaredNorm()); }
    /// The vector turned by +90 degrees: the left normal of a direction, towards free space.
    constexpr Vector2D left() const { return {-y, x}; }
    /// Unit vector of the same direction; the zero vector stays zero.
    Vector2D normalized() const {
        const Scalar length = norm();
        return length > 0 ? *this / length : Vector2D();
    }
    bool isFinite() const { return std::isfinite(x) && std::isfinite(y); }

    /// The same memory seen by Eigen, at no cost.
    Eigen::Map<Eigen::Matrix<Scalar, 2, 1>> eigen() { return Eigen::Map<Eigen::Matrix<Scalar, 2, 1>>(&x); }
    Eigen::Map<const Eigen::Matrix<Scalar, 2, 1>> eigen() const {
        return Eigen::Map<const Eigen::Matrix<Scalar, 2, 1>>(&x);
    }
};

static_assert(sizeof(Vector2D<float>) == 2 * sizeof(float), "a point is two numbers and nothing else");

/// k times v.
template <typename Scalar>
constexpr Vector2D<Scalar> operator*(Scalar k, Vector2D<Scalar> v) {
    return v * k;
}

/// Points in order of acquisition that somebody else owns: a pointer and a count.
template <typename Scalar>
class PointSpan {
public:
    PointSpan() = default;
    PointSpan(const Vector2D<Scalar> *data, std::size_t size)
        : data_(data)
        , size_(size) {}
    PointSpan(const std::vector<Vector2D<Scalar>> &points)
        : PointSpan(points.data(), points.size()) {}

    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    const Vector2D<Scalar> &operator[](std::size_t i) const { return data_[i]; }
    const Vector2D<Scalar> &front() const { return data_[0]; }
    const Vector2D<Scalar> &back() const { return data_[size_ - 1]; }
    const Vector2D<Scalar> *begin() const { return data_; }
    const Vector2D<Scalar> *end() const { return data_ + size_; }
    /// The `count` points from number `first` on; all must be there.
    PointSpan part(std::size_t first, std::size_t count) const { return {data_ + first, count}; }

private:
    const Vector2D<Scalar> *data_ = nullptr;
    std::size_t size_ = 0;
};

} // namespace vectorlib

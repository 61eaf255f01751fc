#pragma once
// Arrays of questions: what is given and what is answered for many items at once, on all cores.
//
// Python (etendue/_arrays.py) has converted what is given to contiguous arrays of the right type, whose first axis has one row
// for each item, or a single row for all of them.

#include <nanobind/ndarray.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstring>
#include <initializer_list>
#include <memory>
#include <vector>

#include "binding.h"
#include "etendue/core/arena.h"
#include "etendue/core/spectrum.h"
#include "etendue/core/vector.h"
#include "live_render.h"

namespace etendue::python {

template <class T>
using Array = nb::ndarray<const T, nb::c_contig, nb::device::cpu>;

/// The rows of an array that is given.
template <class T>
class Rows {
 public:
  Rows(const Array<T>& array)  // NOLINT: an array is its rows
      : data_(array.data()), stride_(array.shape(0) > 1 ? array.size() / array.shape(0) : 0) {}
  const T* operator[](size_t i) const { return data_ + i * stride_; }
  T at(size_t i) const { return data_[i * stride_]; }

 private:
  const T* data_;
  size_t stride_;
};

inline Vector3 vector_at(const Rows<float>& rows, size_t i) {
  const float* const p = rows[i];
  return {p[0], p[1], p[2]};
}
inline Point2 point2_at(const Rows<float>& rows, size_t i) { return {rows[i][0], rows[i][1]}; }

/// A direction of any length, made a unit vector; false if it has none: for (0, 0, 0) and what is not finite.
inline bool make_unit(Vector3& v) {
  const float squared = length_squared(v);
  if (squared > 1 - 1e-6f && squared < 1 + 1e-6f) return true;
  if (squared > 1e-30f && squared < 1e30f) {
    v = v / std::sqrt(squared);
    return true;
  }
  const double x = v.x, y = v.y, z = v.z, exact = std::sqrt(x * x + y * y + z * z);
  if (!(exact > 0) || !std::isfinite(exact)) return false;
  v = {float(x / exact), float(y / exact), float(z / exact)};
  return true;
}

/// An array of answers, which NumPy owns in the end. Its numbers are not initialized.
template <class T>
class Answers {
 public:
  Answers(std::initializer_list<size_t> shape) : shape_(shape) {
    size_t size = 1;
    for (const size_t n : shape_) size *= n;
    width_ = shape_.size() > 1 ? size / std::max<size_t>(shape_[0], 1) : 1;
    data_.reset(new T[std::max<size_t>(size, 1)]);
  }
  T* operator[](size_t i) { return data_.get() + i * width_; }
  void set(size_t i, const Vector3& v) { put(i, v.x, v.y, v.z); }
  void set(size_t i, const Normal3& v) { put(i, v.x, v.y, v.z); }
  void set(size_t i, const Point3& v) { put(i, v.x, v.y, v.z); }
  void set(size_t i, const DoublePoint3& v) { put(i, v.x, v.y, v.z); }
  void set(size_t i, T value) { data_[i] = value; }
  /// The array; this object has none after it.
  nb::object take() {
    T* const data = data_.release();
    const nb::capsule owner(data, [](void* p) noexcept { delete[] static_cast<T*>(p); });
    return nb::cast(nb::ndarray<nb::numpy, T>(data, shape_.size(), shape_.data(), owner), nb::rv_policy::reference);
  }

 private:
  template <class X>
  void put(size_t i, X x, X y, X z) {
    T* const p = (*this)[i];
    p[0] = T(x), p[1] = T(y), p[2] = T(z);
  }
  std::vector<size_t> shape_;
  size_t width_ = 1;
  std::unique_ptr<T[]> data_;
};

/// Calls work(i, arena) for all items, on all cores and without the interpreter's lock. The arena is emptied after each item.
template <class F>
void for_all(size_t count, F&& work) {
  constexpr size_t block = 256;
  use_threads();
  released([&] {
    tbb::parallel_for(tbb::blocked_range<size_t>(0, count, block), [&](const tbb::blocked_range<size_t>& items) {
      Arena arena;
      for (size_t i = items.begin(); i < items.end(); ++i) {
        work(i, arena);
        arena.reset();
      }
    });
  });
}

/// The wavelengths of each item: any number, in groups of as many as a path carries. The last group is filled with copies of
/// its last wavelength.
class WavelengthRows {
 public:
  /// `nm` and `pdf` have a row of wavelengths for each item or one for all; `single` says whether the secondary wavelengths
  /// were dropped.
  WavelengthRows(const Array<float>& nm, const Array<float>& pdf, const Array<bool>& single)
      : nm_(nm), pdf_(pdf), single_(single), count_(nm.shape(1)), groups_((count_ + spectrum_size - 1) / spectrum_size) {
    if (nm.shape(0) != 1) return;
    for (size_t g = 0; g < groups_; ++g) common_.push_back(made(0, g));
  }
  size_t count() const { return count_; }
  size_t groups() const { return groups_; }
  Wavelengths at(size_t i, size_t group = 0) const { return common_.empty() ? made(i, group) : common_[group]; }
  /// Calls value(wavelengths), a Spectrum, for each group, and stores the row of item i.
  template <class F>
  void fill(size_t i, float* row, F&& value) const {
    for (size_t g = 0; g < groups_; ++g) store(value(at(i, g)), g, row);
  }
  void store(const Spectrum& s, size_t group, float* row) const {
    const size_t first = group * spectrum_size, n = std::min<size_t>(count_ - first, spectrum_size);
    std::memcpy(row + first, &s.lanes(), n * sizeof(float));
  }
  void clear(float* row) const { std::fill_n(row, count_, 0.0f); }
  Spectrum load(const float* row, size_t group) const {
    Spectrum s;
    for (int k = 0; k < spectrum_size; ++k) s.set(k, row[from(group, k)]);
    return s;
  }

 private:
  size_t from(size_t group, int k) const { return std::min(group * spectrum_size + size_t(k), count_ - 1); }
  Wavelengths made(size_t i, size_t group) const {
    detail::Lanes lambda, pdf;
    for (int k = 0; k < spectrum_size; ++k) {
      lambda[k] = nm_[i][from(group, k)];
      pdf[k] = pdf_[i][from(group, k)];
    }
    Wavelengths w(lambda, pdf);
    if (single_.at(i)) w.drop_secondary();
    return w;
  }

  Rows<float> nm_, pdf_;
  Rows<bool> single_;
  size_t count_, groups_;
  std::vector<Wavelengths> common_;  // if all items have the same
};

/// The wavelengths that Python gives as a tuple of arrays: nm, pdf, single.
inline WavelengthRows wavelength_rows(const nb::tuple& given) {
  return {nb::cast<Array<float>>(given[0]), nb::cast<Array<float>>(given[1]), nb::cast<Array<bool>>(given[2])};
}

// ---- questions with one answer ---------------------------------------------------------------------------------------------

/// A number for each item, value(i): shape (count,).
template <class F>
nb::object answer_numbers(size_t count, F&& value) {
  Answers<float> values({count});
  for_all(count, [&](size_t i, Arena&) { values.set(i, value(i)); });
  return values.take();
}

/// A spectrum for each item, value(i, wavelengths): shape (count, number of wavelengths).
template <class F>
nb::object answer_spectra(size_t count, const nb::tuple& wavelengths, F&& value) {
  const WavelengthRows rows = wavelength_rows(wavelengths);
  Answers<float> values({count, rows.count()});
  for_all(count, [&](size_t i, Arena&) { rows.fill(i, values[i], [&](const Wavelengths& w) { return value(i, w); }); });
  return values.take();
}

}  // namespace etendue::python

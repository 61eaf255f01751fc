// Texture lookups: texels, and means over elliptical footprints.

#include <algorithm>
#include <cmath>
#include <limits>

#include "cached_texture.h"
#include "image_cache.h"

namespace etendue {

// The mean over an ellipse is computed as in Feline (McCormack, Perry, Farkas and Jouppi 1999, "Feline: fast elliptical lines
// for anisotropic texture mapping"): by probes along its longer axis, each of which averages over a circle by two MIP levels.
// The combined filter is chosen by its second moments, so that it is neither too sharp nor too soft:
// - An ellipse w2 wide and w1 >= w2 long, uniformly filled, has variances w2^2 / 16 and w1^2 / 16 along its axes. These are the
//   variances of a circle of width w2 convolved with a line of length l = sqrt(w1^2 - w2^2) with the density sqrt(1 - x^2), the
//   projection of a circle.
// - A texel of level L is the mean over a square of s = 2^L texels, variance (s^2 - 1) / 12, and the linear interpolation
//   between texels has s^2 / 6. Without a footprint the result is the interpolated texels, variance 1 / 6. So level L blurs by
//   a circle of width w if w^2 / 16 + 1 / 6 = (s^2 - 1) / 12 + s^2 / 6, or s^2 = 1 + w^2 / 4: level 0 for w = 0, as it should
//   be.
// - Between two levels the weight is the fractional part of the level, log2(s). Weights by variance would give the coarser
//   level a little less, but these are nearer to the mean over an ellipse: on white noise by 5 to 25 percent of the error.
// Probes are no farther apart than texels of their level.

namespace {

/// The index inside the image for a texel index outside; -1: none (black).
int wrapped(int i, int size, Wrap wrap) {
  switch (wrap) {
    case Wrap::repeat: i %= size; return i < 0 ? i + size : i;
    case Wrap::mirror:
      i %= 2 * size;
      i = i < 0 ? i + 2 * size : i;
      return i < size ? i : 2 * size - 1 - i;
    case Wrap::clamp: return i < 0 ? 0 : size - 1;
    default: return -1;
  }
}

}  // namespace

/// Adds up weighted texels of one level of an image. For an image in the cache it keeps references to four tiles, those that
/// meet in a corner, since requesting a tile takes longer than reading many texels.
class TexelReader {
 public:
  TexelReader(const CachedTexture& texture, size_t level, Wraps wrap, float* sum)
      : texture_(texture), level_(texture.levels_[level]), wrap_(wrap), sum_(sum) {}
  ~TexelReader() {
    if (holds_)
      for (const Held& held : held_)
        if (held.tile) image_cache().release_tile(held.tile);
  }
  TexelReader(const TexelReader&) = delete;
  TexelReader& operator=(const TexelReader&) = delete;

  float width() const { return float(level_.width); }
  float height() const { return float(level_.height); }

  /// Adds a texel times a weight.
  void add(int x, int y, float weight) {
    if (unsigned(x) >= unsigned(level_.width)) x = wrapped(x, level_.width, wrap_.u);
    if (unsigned(y) >= unsigned(level_.height)) y = wrapped(y, level_.height, wrap_.v);
    if (x < 0 || y < 0) return;
    if (level_.texels.empty() && texture_.kept_) {
      x -= texture_.begin_x_;
      y -= texture_.begin_y_;
      if (unsigned(x) < unsigned(texture_.pixels_x_) && unsigned(y) < unsigned(texture_.pixels_y_))
        texture_.kept_->add_to(sum_, place(x, y, texture_.pixels_x_), texture_.channels_, weight);
      return;
    }
    const float* const texel = level_.texels.empty() ? cached(x, y) : &level_.texels[place(x, y, level_.width)];
    if (!texel) return;
    sum_[0] += weight * texel[0];
    if (texture_.channels_ == 3) {
      sum_[1] += weight * texel[1];
      sum_[2] += weight * texel[2];
    }
  }
  /// Adds the bilinear interpolation of four texels, whose centres have integer coordinates.
  void add_between(float x, float y, float weight) {
    const float left = std::floor(x), top = std::floor(y), fx = x - left, fy = y - top;
    const int i = int(left), k = int(top);
    add(i, k, weight * (1 - fx) * (1 - fy));
    if (fx > 0) add(i + 1, k, weight * fx * (1 - fy));
    if (fy > 0) add(i, k + 1, weight * (1 - fx) * fy);
    if (fx > 0 && fy > 0) add(i + 1, k + 1, weight * fx * fy);
  }

 private:
  /// A texel of level 0; null outside the stored pixels, and if the file was removed after it was opened.
  const float* cached(int x, int y) {
    x -= texture_.begin_x_;
    y -= texture_.begin_y_;
    if (unsigned(x) >= unsigned(texture_.pixels_x_) || unsigned(y) >= unsigned(texture_.pixels_y_)) return nullptr;
    constexpr int side = CachedTexture::tile_side;
    Held& held = held_[(x / side) % 2 + 2 * ((y / side) % 2)];
    if (unsigned(x - held.x) >= unsigned(side) || unsigned(y - held.y) >= unsigned(side)) hold(held, x, y);
    return held.texels ? held.texels + place(x - held.x, y - held.y, held.width) : nullptr;
  }
  struct Held {
    OIIO::ImageCache::Tile* tile = nullptr;
    const float* texels = nullptr;
    int x = -CachedTexture::tile_side, y = 0, width = 0;
  };
  void hold(Held& held, int x, int y) {
    OIIO::ImageCache& cache = image_cache();
    thread_local OIIO::ImageCache::Perthread* const thread = cache.get_perthread_info();
    if (held.tile) cache.release_tile(held.tile);
    held = {};
    holds_ = true;
    const int file_x = texture_.left_ + texture_.begin_x_, file_y = texture_.top_ + texture_.begin_y_;
    held.tile = cache.get_tile(texture_.handle_, thread, 0, 0, x + file_x, y + file_y, 0);
    if (!held.tile) return;
    OIIO::TypeDesc format;
    held.texels = static_cast<const float*>(cache.tile_pixels(held.tile, format));
    const OIIO::ROI roi = cache.tile_roi(held.tile);
    held.x = roi.xbegin - file_x;
    held.y = roi.ybegin - file_y;
    held.width = roi.width();
  }
  size_t place(int x, int y, int width) const { return (size_t(y) * size_t(width) + size_t(x)) * size_t(texture_.channels_); }

  const CachedTexture& texture_;
  const CachedTexture::Level& level_;
  Wraps wrap_;
  float* sum_;
  Held held_[4];
  bool holds_ = false;
};

namespace {

/// The axes of an elliptical footprint, in texels.
struct Ellipse {
  float longer = 0, shorter = 0;
  Vector2 direction{1, 0};  // of the longer axis, unit length
};

/// A footprint's two vectors are conjugate diameters. With A the matrix of them as columns, the axes are the square roots of
/// the eigenvalues of A A^T, whose product is |det A|.
Ellipse ellipse_of(const UvFootprint& f, float width, float height) {
  double a = double(f.longer.x) * double(width), b = double(f.longer.y) * double(height);
  double c = double(f.shorter.x) * double(width), d = double(f.shorter.y) * double(height);
  // Much larger footprints give the mean of the image.
  const double most = std::max({std::abs(a), std::abs(b), std::abs(c), std::abs(d)}), enough = 1e6;
  if (!(most < std::numeric_limits<double>::infinity())) return {float(enough), float(enough), {1, 0}};
  if (most > enough) a *= enough / most, b *= enough / most, c *= enough / most, d *= enough / most;
  const double xx = a * a + c * c, yy = b * b + d * d, xy = a * b + c * d, half = (xx - yy) / 2;
  const double root = std::sqrt(half * half + xy * xy), square = (xx + yy) / 2 + root;
  if (!(square > 1e-30)) return {};
  const double longer = std::sqrt(square);
  Ellipse e{float(longer), float(std::abs(a * d - b * c) / longer), {1, 0}};
  const double x = half >= 0 ? half + root : xy, y = half >= 0 ? xy : root - half, norm = std::sqrt(x * x + y * y);
  if (norm > 0) e.direction = {float(x / norm), float(y / norm)};
  return e;
}

/// The level that blurs by a circle of this width in texels.
float detail_of(float width) { return 0.5f * std::log2(1 + square(width) / 4); }

/// Moves coordinates so close to the image that integers can index texels; `texels`: number along its longer side.
Point2 near(Point2 at, Wraps wrap, int texels) {
  if (!(std::isfinite(at.x) && std::isfinite(at.y))) return {NAN, NAN};
  const float far = std::min(1000.0f, 1e9f / float(texels));
  const auto nearer = [far](float x, Wrap w) {
    if (w == Wrap::repeat) return x - std::floor(x);
    if (w == Wrap::mirror) return x - 2 * std::floor(x / 2);
    return clamp(x, -far, far);
  };
  return {nearer(at.x, wrap.u), nearer(at.y, wrap.v)};
}

}  // namespace

void CachedTexture::nearest(Point2 at, Wraps wrap, float* out) const {
  std::fill_n(out, channels_, 0.0f);
  at = near(at, wrap, std::max(levels_[0].width, levels_[0].height));
  if (!(at.x == at.x)) return;
  TexelReader reader(*this, 0, wrap, out);
  reader.add(int(std::floor(at.x * reader.width())), int(std::floor((1 - at.y) * reader.height())), 1.0f);
}

void CachedTexture::bilinear(Point2 at, Wraps wrap, float* out) const {
  std::fill_n(out, channels_, 0.0f);
  at = near(at, wrap, std::max(levels_[0].width, levels_[0].height));
  if (!(at.x == at.x)) return;
  const float x = at.x * float(levels_[0].width) - 0.5f, y = (1 - at.y) * float(levels_[0].height) - 0.5f;
  if (kept_whole_ && add_kept_between(x, y, wrap, out)) return;
  TexelReader(*this, 0, wrap, out).add_between(x, y, 1);
}

/// TexelReader::add_between for an image that is stored in memory and fills its display window: the usual case, in half the
/// time. False: some of the texels are outside, where the image is black.
bool CachedTexture::add_kept_between(float x, float y, Wraps wrap, float* out) const {
  const float left = std::floor(x), top = std::floor(y), fx = x - left, fy = y - top;
  int columns[2] = {int(left), int(left) + 1}, rows[2] = {int(top), int(top) + 1};
  for (int i = 0; i < 2; ++i) {
    if (unsigned(columns[i]) >= unsigned(pixels_x_)) columns[i] = wrapped(columns[i], pixels_x_, wrap.u);
    if (unsigned(rows[i]) >= unsigned(pixels_y_)) rows[i] = wrapped(rows[i], pixels_y_, wrap.v);
    if (columns[i] < 0 || rows[i] < 0) return false;
  }
  const float weights[2][2] = {{(1 - fx) * (1 - fy), fx * (1 - fy)}, {(1 - fx) * fy, fx * fy}};
  for (int k = 0; k < 2; ++k)
    for (int i = 0; i < 2; ++i) {
      const size_t place = (size_t(rows[k]) * size_t(pixels_x_) + size_t(columns[i])) * size_t(channels_);
      kept_->add_to(out, place, channels_, weights[k][i]);
    }
  return true;
}

float CachedTexture::texels_along(const UvFootprint& f) const {
  return ellipse_of(f, float(levels_[0].width), float(levels_[0].height)).longer;
}

void CachedTexture::mean(Point2 at, const UvFootprint& f, Wraps wrap, float* out) const {
  std::call_once(levels_made_, [this] { make_levels(); });
  const float width = float(levels_[0].width), height = float(levels_[0].height);
  const Ellipse e = ellipse_of(f, width, height);
  const float shorter = std::max(e.shorter, e.longer / maximum_anisotropy);
  const float length = safe_sqrt((e.longer - shorter) * (e.longer + shorter));
  const Vector2 half_line{0.5f * length * e.direction.x / width, 0.5f * length * e.direction.y / height};
  line(at, half_line, length, detail_of(shorter), wrap, out);
}

void CachedTexture::line(Point2 at, Vector2 half_line, float length, float detail, Wraps wrap, float* out) const {
  std::fill_n(out, channels_, 0.0f);
  at = near(at, wrap, std::max(levels_[0].width, levels_[0].height));
  if (!(at.x == at.x)) return;
  const size_t top = levels_.size() - 1;
  const auto add_level = [&](size_t level, float size, float share) {
    TexelReader reader(*this, level, wrap, out);
    const float w = reader.width(), h = reader.height(), x = at.x * w - 0.5f, y = (1 - at.y) * h - 0.5f;
    constexpr float most = 4 * maximum_anisotropy;
    const int count = length > 0.1f * size ? std::max(2, int(std::min(std::ceil(length / size), most))) : 1;
    if (count == 1) return reader.add_between(x, y, share);
    const Vector2 reach{half_line.x * w, -half_line.y * h};
    const float step = 2 / float(count);
    float total = 0;
    for (int i = 0; i < count; ++i) total += safe_sqrt(1 - square((float(i) + 0.5f) * step - 1));
    for (int i = 0; i < count; ++i) {
      const float place = (float(i) + 0.5f) * step - 1;
      reader.add_between(x + place * reach.x, y + place * reach.y, share / total * safe_sqrt(1 - place * place));
    }
  };
  const size_t finer = std::min(size_t(detail), top);
  const float size = std::ldexp(1.0f, int(finer)), t = finer < top ? detail - float(finer) : 0;
  constexpr float hardly = 1e-3f;
  if (t < 1 - hardly) add_level(finer, size, t > hardly ? 1 - t : 1);
  if (t > hardly) add_level(finer + 1, 2 * size, t < 1 - hardly ? t : 1);
}

}  // namespace etendue

#pragma once
// Mattes alone: which objects, materials, assets and groups the samples of a picture see first, without its light.

#include <functional>
#include <vector>

#include "etendue/render/render.h"
#include "images/cryptomatte.h"

namespace etendue {

/// The mattes that a render's picture has as layers of every kind: "crypto_object", "crypto_material", "crypto_asset" and, if
/// the job has groups, "crypto_group". `go_on` is called now and then with the part that is done; false ends the work, and the
/// result is empty. The result does not depend on `threads` (0: all cores).
std::vector<Cryptomatte> render_mattes(const Render&, int threads, const std::function<bool(double)>& go_on);

}  // namespace etendue

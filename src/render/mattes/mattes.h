#pragma once
// Mattes: which objects, materials and assets the samples of a picture see first.

#include <functional>
#include <vector>

#include "etendue/render/render.h"
#include "images/cryptomatte.h"

namespace etendue {

/// The mattes of a render's picture: "crypto_object", "crypto_material" and "crypto_asset". The samples are those of the
/// render: the same film points, lens points and times, and the film's filter. `go_on` is called now and then with the part
/// that is done; false ends the work, and the result is empty. The result does not depend on `threads` (0: all cores).
///
/// An object is named by the path of names from the scene to it, such as "tree_2/leaf", where instances have names of their
/// own; an asset by the first part of this path. What has no name is called by its class and a number in the order of the file.
/// The same name is the same matte.
std::vector<Cryptomatte> render_mattes(const Render&, int threads, const std::function<bool(double)>& go_on);

}  // namespace etendue

#pragma once
// Compiled once: what most sources include.

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "etendue/describe/description.h"
#include "etendue/render/renderer.h"

#pragma once
// The page of a comparison: one HTML file that needs nothing else.

#include "analysis.h"
#include "etendue/tone_map.h"

namespace etendue::comparing {

/// The looks of what `scene_pictures` makes.
extern const std::string_view picture_style;
/// The pictures and maps of a scene, as HTML; made while its numbers are at hand.
std::string scene_pictures(const SceneResult&, const SceneImages&, const ToneMap&, const std::vector<PixelArea>& insets);

/// `pictures`: of each scene.
std::string html_report(const Results&, const std::vector<std::string>& pictures, const std::string& command_line);

}  // namespace etendue::comparing

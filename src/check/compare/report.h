#pragma once
// The page of a comparison: one self-contained HTML file.

#include "analysis.h"
#include "etendue/tone_map.h"

namespace etendue::comparing {

/// The CSS of what `scene_pictures` returns.
extern const std::string_view picture_style;
/// The images and maps of a scene, as HTML; made while its images are in memory.
std::string scene_pictures(const SceneResult&, const SceneImages&, const ToneMap&, const std::vector<PixelArea>& insets);

/// `pictures`: the HTML of scene_pictures for each scene.
std::string html_report(const Results&, const std::vector<std::string>& pictures, const std::string& command_line);

}  // namespace etendue::comparing

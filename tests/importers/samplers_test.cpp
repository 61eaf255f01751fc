// Samplers of pbrt and Mitsuba become the same here, and those of pbrt go back.

#include "etendue/exporter.h"
#include "pbrt_support.h"

namespace etendue {
namespace {

/// The sampler of a scene with its members, as a description writes them.
std::string sampler_of(const Job& job) {
  std::string text = job.renderer->sampler->class_info().name;
  for (const Member& m : job.renderer->sampler->class_info().members) {
    const Value value = get(*job.renderer->sampler, m.name);
    const auto* number = value.as<Number>();
    const auto* truth = value.as<bool>();
    text += " " + m.name + "=" + (number ? std::to_string(int(number->value)) : truth && *truth ? "true" : "false");
  }
  return text;
}

TEST(ImportedSamplers, OfPbrt) {
  const std::pair<const char*, const char*> samplers[] = {
      {"\"independent\" \"integer pixelsamples\" 8", "IndependentSampler"},
      {"\"stratified\" \"integer xsamples\" 8 \"integer ysamples\" 2", "StratifiedSampler x=8 y=2"},
      {"\"halton\" \"integer pixelsamples\" 7", "HaltonSampler"},
      {"\"paddedsobol\" \"integer pixelsamples\" 16", "SobolSampler"},
      {"\"sobol\" \"integer pixelsamples\" 16", "SobolSampler"},
      {"\"zsobol\" \"integer pixelsamples\" 64", "ZSobolSampler samples=64"},
      {"\"pmj02bn\" \"integer pixelsamples\" 32", "Pmj02Sampler blue_noise=true"},
  };
  for (const auto& [theirs, ours] : samplers) {
    const TemporaryFolder folder;
    const auto scene = [](const std::string& sampler) {
      return "Camera \"perspective\"\nSampler " + sampler + "\nWorldBegin\nLightSource \"infinite\"\nShape \"sphere\"\n";
    };
    const pbrt_test::Imported imported = pbrt_test::import_text(folder, scene(theirs));
    ASSERT_TRUE(imported.job) << imported.told();
    EXPECT_EQ(imported.told(), "") << theirs;
    EXPECT_EQ(sampler_of(*imported.job), ours);
    const std::string path = folder / "again.pbrt";
    Exporting exporting(path);
    const std::string written = exporter_of(path)->write(*imported.job, exporting);
    if (std::string(theirs).starts_with("\"sobol")) continue;  // goes back as paddedsobol, which it is
    EXPECT_NE(written.find("Sampler " + std::string(theirs) + "\n"), std::string::npos) << written;
  }
}

TEST(ImportedSamplers, OfMitsuba) {
  const std::pair<const char*, const char*> samplers[] = {
      {"independent", "IndependentSampler"}, {"stratified", "StratifiedSampler x=5 y=5"}, {"ldsampler", "SobolSampler"}};
  for (const auto& [theirs, ours] : samplers) {
    const TemporaryFolder folder;
    const std::string path = folder.write(
        "scene.xml",
        std::string("<scene version=\"3.0.0\"><integrator type=\"path\"/><sensor type=\"perspective\"><sampler type=\"") +
            theirs + "\"><integer name=\"sample_count\" value=\"20\"/></sampler></sensor><emitter type=\"constant\"/></scene>");
    Importing importing(path, {});
    const Ref<Job> job = ref_cast<Job>(importer_of(path)->import(importing));
    ASSERT_TRUE(job);
    EXPECT_EQ(sampler_of(*job), ours);
    EXPECT_EQ(job->renderer->samples, 20);
  }
}

}  // namespace
}  // namespace etendue

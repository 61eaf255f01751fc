#include "language_test_support.h"

namespace etendue {

static const Register<LanguagePart> part_registered;
static const Register<LanguageConstant> constant_registered;
static const Register<LanguageNeedy> needy_registered;

}  // namespace etendue

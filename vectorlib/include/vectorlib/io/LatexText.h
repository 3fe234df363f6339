#pragma once

#include "vectorlib/Body.h"

#include <cstdio>
#include <string>

namespace vectorlib {

namespace latex {

/// What stands for a character that is no letter; nothing where there is none.
const char *sign(char32_t c);

/// Letters beyond ASCII that the fonts of the T1 encoding have.
bool isLetter(char32_t c);

/// One character of ASCII; control characters are blanks.
std::string plain(char c, char next);

/// Whether an exponent begins behind a ^: m^2, s^-1.
std::size_t exponentLength(const std::string &text, std::size_t at);

} // namespace latex

/// Any UTF-8 text as it must be written in a LaTeX document with the T1 encoding; `^2` and the like are
/// raised. What pdflatex has no sign for stands as its number, [U+4E2D]; bytes that are no UTF-8 as ?.
std::string latexText(const std::string &text);

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/io/LatexText.cpp")

#pragma once

#include "vectorlib/Body.h"

#include <string>

namespace vectorlib {

/// A character of a text in UTF-8, and how many bytes it takes: 1 where it is none.
struct Utf8Character {
    char32_t code = 0;
    std::size_t length = 1;
    bool isValid() const { return code != 0; }
};

/// The character that begins at a byte of the text. No such character are bytes that are cut short or stand
/// alone, longer forms than needed, surrogates, and what lies beyond Unicode.
Utf8Character nextCharacter(const std::string &text, std::size_t at);

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/io/Utf8.cpp")

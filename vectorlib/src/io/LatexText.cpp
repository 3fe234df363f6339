#include "vectorlib/io/LatexText.h"

#include "vectorlib/io/Utf8.h"

#include <algorithm>

namespace vectorlib {

VECTORLIB_BODY const char *latex::sign(char32_t c) {
    struct Sign {
        char32_t code;
        const char *latex;
    };
    static constexpr Sign signs[] = {{0xa0, "~"},
                                     {0xb0, "\\ensuremath{^\\circ}"},
                                     {0xb1, "\\ensuremath{\\pm}"},
                                     {0xb2, "\\ensuremath{^2}"},
                                     {0xb3, "\\ensuremath{^3}"},
                                     {0xb5, "\\ensuremath{\\mu}"},
                                     {0xb7, "\\ensuremath{\\cdot}"},
                                     {0xb9, "\\ensuremath{^1}"},
                                     {0xd7, "\\ensuremath{\\times}"},
                                     {0xf7, "\\ensuremath{\\div}"},
                                     {0x394, "\\ensuremath{\\Delta}"},
                                     {0x3a3, "\\ensuremath{\\Sigma}"},
                                     {0x3a9, "\\ensuremath{\\Omega}"},
                                     {0x3b1, "\\ensuremath{\\alpha}"},
                                     {0x3b2, "\\ensuremath{\\beta}"},
                                     {0x3b3, "\\ensuremath{\\gamma}"},
                                     {0x3b4, "\\ensuremath{\\delta}"},
                                     {0x3b5, "\\ensuremath{\\epsilon}"},
                                     {0x3b8, "\\ensuremath{\\theta}"},
                                     {0x3bb, "\\ensuremath{\\lambda}"},
                                     {0x3bc, "\\ensuremath{\\mu}"},
                                     {0x3c0, "\\ensuremath{\\pi}"},
                                     {0x3c1, "\\ensuremath{\\rho}"},
                                     {0x3c3, "\\ensuremath{\\sigma}"},
                                     {0x3c4, "\\ensuremath{\\tau}"},
                                     {0x3c6, "\\ensuremath{\\varphi}"},
                                     {0x3c9, "\\ensuremath{\\omega}"},
                                     {0x2013, "--"},
                                     {0x2014, "---"},
                                     {0x2026, "\\ensuremath{\\dots}"},
                                     {0x2192, "\\ensuremath{\\to}"},
                                     {0x2212, "\\ensuremath{-}"},
                                     {0x221a, "\\ensuremath{\\surd}"},
                                     {0x221e, "\\ensuremath{\\infty}"},
                                     {0x2248, "\\ensuremath{\\approx}"},
                                     {0x2264, "\\ensuremath{\\leq}"},
                                     {0x2265, "\\ensuremath{\\geq}"}};
    const auto *found =
        std::find_if(std::begin(signs), std::end(signs), [c](const Sign &s) { return s.code == c; });
    return found == std::end(signs) ? nullptr : found->latex;
}

VECTORLIB_BODY bool latex::isLetter(char32_t c) {
    static constexpr char32_t extended[] = {
        0x102, 0x103, 0x104, 0x105, 0x106, 0x107, 0x10c, 0x10d, 0x10e, 0x10f, 0x110, 0x111,
        0x118, 0x119, 0x11a, 0x11b, 0x11e, 0x11f, 0x130, 0x131, 0x139, 0x13a, 0x13d, 0x13e,
        0x141, 0x142, 0x143, 0x144, 0x147, 0x148, 0x150, 0x151, 0x152, 0x153, 0x154, 0x155,
        0x158, 0x159, 0x15a, 0x15b, 0x15e, 0x15f, 0x160, 0x161, 0x162, 0x163, 0x164, 0x165,
        0x16e, 0x16f, 0x170, 0x171, 0x178, 0x179, 0x17a, 0x17b, 0x17c, 0x17d, 0x17e};
    return (c >= 0xc0 && c <= 0xff) || std::binary_search(std::begin(extended), std::end(extended), c);
}

VECTORLIB_BODY std::string latex::plain(char c, char next) {
    if (c == '\\')
        return "\\textbackslash{}";
    if (c == '^' || c == '~')
        return std::string("\\") + c + "{}";
    if (std::string("#$%&_{}").find(c) != std::string::npos)
        return std::string("\\") + c;
    if (c == '[' || c == ']' || c == '*') // else an option where it follows a command, as the end of a line
        return std::string("{") + c + '}';
    if (static_cast<unsigned char>(c) < ' ' || c == 127)
        return " ";
    // Two of them together, or a quotation mark behind, would become another sign.
    const bool joins = (c == next && std::string("-`',<>").find(c) != std::string::npos) ||
                       (next == '`' && (c == '?' || c == '!'));
    return joins ? std::string(1, c) + "{}" : std::string(1, c);
}

VECTORLIB_BODY std::size_t latex::exponentLength(const std::string &text, std::size_t at) {
    std::size_t end = at;
    if (end < text.size() && text[end] == '-')
        ++end;
    const std::size_t digits = end;
    while (end < text.size() && text[end] >= '0' && text[end] <= '9')
        ++end;
    return end > digits ? end - at : 0;
}

VECTORLIB_BODY std::string latexText(const std::string &text) {
    std::string result;
    for (std::size_t i = 0; i < text.size();) {
        if (static_cast<unsigned char>(text[i]) < 0x80) {
            const std::size_t raised = text[i] == '^' ? latex::exponentLength(text, i + 1) : 0;
            result += raised > 0 ? "\\ensuremath{^{" + text.substr(i + 1, raised) + "}}"
                                 : latex::plain(text[i], i + 1 < text.size() ? text[i + 1] : '\0');
            i += 1 + raised;
            continue;
        }
        const Utf8Character c = nextCharacter(text, i);
        if (!c.isValid()) {
            result += '?';
        } else if (const char *sign = latex::sign(c.code)) {
            result += sign;
        } else if (latex::isLetter(c.code)) {
            result += text.substr(i, c.length);
        } else {
            char number[24];
            std::snprintf(number, sizeof number, "{[}U+%04X{]}", static_cast<unsigned>(c.code));
            result += number;
        }
        i += c.length;
    }
    return result;
}

} // namespace vectorlib

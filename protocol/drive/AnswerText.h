#pragma once

#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace hermes::drive {

/// So many decimal numbers with this between them, modulo 2^32; nothing: the text is no such, or one does not
/// fit 32 bits.
template <std::size_t most>
std::optional<std::array<std::uint32_t, most>> numbersIn(std::string_view text, char between,
                                                         std::size_t count = most) {
    std::array<std::uint32_t, most> numbers{};
    for (std::size_t i = 0; i < count; ++i) {
        if (i > 0 && (text.empty() || text[0] != between))
            return {};
        text.remove_prefix(i > 0);
        std::int32_t number = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
        if (error != std::errc())
            return {};
        numbers[i] = std::uint32_t(number);
        text.remove_prefix(std::size_t(end - text.data()));
    }
    return text.empty() ? std::optional(numbers) : std::nullopt;
}

/// What a device calls itself, until the first byte that is no letter for people.
inline std::string nameIn(std::string_view text) {
    std::size_t size = 0;
    while (size < text.size() && text[size] >= ' ' && text[size] <= '~')
        ++size;
    return std::string(text.substr(0, size));
}

} // namespace hermes::drive

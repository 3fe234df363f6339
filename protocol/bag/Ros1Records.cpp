#include "protocol/bag/Ros1Records.h"

#include <algorithm>

namespace hermes::bag {

namespace {

/// Bytes with their length before them. false: they are not all there.
bool takeBytes(std::string_view &from, std::string_view &bytes) {
    std::uint32_t size = 0;
    if (!mcap::takeField(from, size) || size > from.size())
        return false;
    bytes = from.substr(0, size);
    from.remove_prefix(size);
    return true;
}

} // namespace

bool Ros1Fields::read(std::string_view bytes) {
    fields_.clear();
    while (!bytes.empty()) {
        std::string_view field;
        if (!takeBytes(bytes, field))
            return false;
        const std::size_t end = field.find('=');
        if (end == std::string_view::npos)
            return false;
        fields_.emplace_back(field.substr(0, end), field.substr(end + 1));
    }
    return true;
}

std::string_view Ros1Fields::text(const char *name) const {
    for (const auto &[key, value] : fields_)
        if (key == name)
            return value;
    return {};
}

bool Ros1Fields::time(const char *name, std::uint64_t &value_ns) const {
    std::uint64_t stamp = 0;
    const bool isThere = number(name, stamp);
    value_ns = nanosecondsOf(stamp);
    return isThere;
}

bool Ros1Cursor::next() {
    if (left_.substr(0, 4) == std::string_view("\0\0\0\0", 4)) // no record begins so
        left_.remove_prefix(std::min(left_.find_first_not_of('\0'), left_.size()));
    std::string_view from = left_, header;
    std::uint8_t kind = 0;
    if (!takeBytes(from, header) || !takeBytes(from, data) || !fields.read(header) ||
        !fields.number("op", kind))
        return false;
    at = size_ - left_.size();
    op = Ros1Op(kind);
    left_ = from;
    return true;
}

std::uint64_t nanosecondsOf(std::uint64_t stamp) {
    return (stamp & 0xFFFFFFFF) * 1000000000 + (stamp >> 32);
}

} // namespace hermes::bag

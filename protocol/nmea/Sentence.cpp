#include "protocol/nmea/Sentence.h"

#include <algorithm>

namespace hermes::nmea {

std::uint8_t checksum(std::string_view bytes) {
    std::uint8_t sum = 0;
    for (const char byte : bytes)
        sum = std::uint8_t(sum ^ std::uint8_t(byte));
    return sum;
}

std::string_view Sentence::type() const {
    const std::string_view name = address();
    return name.size() == 5 && name[0] != 'P' ? name.substr(2) : std::string_view();
}

std::string_view Sentence::field(int n) const {
    std::string_view rest = body_;
    for (; n > 0; --n) {
        const std::size_t comma = rest.find(',');
        if (comma == std::string_view::npos)
            return {};
        rest.remove_prefix(comma + 1);
    }
    return rest.substr(0, rest.find(','));
}

int Sentence::fieldCount() const {
    return int(std::count(body_.begin(), body_.end(), ','));
}

SentenceText::SentenceText(std::string_view address) {
    append("$");
    append(address);
}

void SentenceText::addField(std::string_view text) {
    append(",");
    append(text);
}

bool SentenceText::finish() {
    constexpr char digits[] = "0123456789ABCDEF";
    const std::uint8_t sum = checksum(view().substr(1));
    const char tail[] = {'*', digits[sum >> 4], digits[sum & 15]};
    append({tail, sizeof tail});
    if (tooLong_) {
        size_ = 0;
        return false;
    }
    text_[size_++] = '\r';
    text_[size_++] = '\n';
    return true;
}

void SentenceText::append(std::string_view text) {
    tooLong_ = tooLong_ || size_ + text.size() > maxSentence;
    if (!tooLong_)
        size_ += text.copy(text_.data() + size_, text.size());
}

} // namespace hermes::nmea

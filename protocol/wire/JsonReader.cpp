#include "protocol/wire/WireTree.h"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <rapidjson/error/en.h>
#include <string_view>

namespace hermes {
namespace {

/// A number with a point, up to 15 digits and no exponent: the digits divided by a power of ten, both exact,
/// so that the result is rounded once (Clinger, 1990). Nothing for others.
std::optional<double> shortDecimal(const char *at, const char *end) {
    static constexpr double powers[] = {1,   1e1, 1e2,  1e3,  1e4,  1e5,  1e6, 1e7,
                                        1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14};
    const bool isNegative = *at == '-';
    at += isNegative;
    if (end - at > 16)
        return std::nullopt;
    std::int64_t digits = 0;
    const char *point = nullptr;
    for (; at != end; ++at) {
        if (*at == '.')
            point = at;
        else if (*at >= '0' && *at <= '9')
            digits = 10 * digits + (*at - '0');
        else
            return std::nullopt;
    }
    if (!point)
        return std::nullopt;
    const double value = double(digits) / powers[end - point - 1];
    return isNegative ? -value : value;
}

/// Numbers come as they are written.
class JsonBuilder : public TreeBuilder {
public:
    using Ch = char;
    using TreeBuilder::TreeBuilder;

    bool Int(int) { return false; }
    bool Uint(unsigned) { return false; }
    bool Uint64(std::uint64_t) { return false; }
    /// Its grammar is checked already. What is nearer to 0 than any number is 0.
    bool RawNumber(const char *text, unsigned length, bool) {
        const char *const end = text + length;
        if (const auto decimal = shortDecimal(text, end))
            return Double(*decimal);
        qint64 whole = 0;
        if (const auto read = std::from_chars(text, end, whole); read.ptr == end && read.ec == std::errc())
            return Int64(whole);
        double number = 0;
        if (std::from_chars(text, end, number).ec == std::errc::result_out_of_range &&
            !isSmall({text, length}))
            complaint = QStringLiteral("Number too big to be stored in double");
        return complaint.isEmpty() && Double(number);
    }

private:
    static bool isSmall(std::string_view number) {
        const auto exponent = number.find_first_of("eE");
        return exponent == std::string_view::npos ? number.find('.') != std::string_view::npos
                                                  : number[exponent + 1] == '-';
    }
};

/// Without the full stop at its end: it becomes part of a sentence.
QString parserMessage(rapidjson::ParseErrorCode code) {
    QString message = QString::fromLatin1(rapidjson::GetParseError_En(code));
    if (message.endsWith(QLatin1Char('.')))
        message.chop(1);
    return message;
}

} // namespace

std::optional<WireValue> WireValue::parse(const QByteArray &json, WireError *error,
                                          const WireLimits &limits) {
    const auto made = std::make_shared<Tree>();
    made->text = json + QByteArray(4, '\0'); // a character that is cut off makes the parser read on
    const void *const zero =
        std::memchr(json.constData(), 0, std::size_t(json.size())); // to the parser the end
    JsonBuilder builder(made->document, limits);
    rapidjson::ParseResult result;
    const auto generate = [&](rapidjson::Document &) {
        rapidjson::InsituStringStream bytes(made->text.data());
        constexpr unsigned flags = rapidjson::kParseInsituFlag | rapidjson::kParseNumbersAsStringsFlag |
                                   rapidjson::kParseValidateEncodingFlag;
        result = rapidjson::Reader().Parse<flags>(bytes, builder);
        return !result.IsError();
    };
    made->document.Populate(generate);
    if (result.IsError() || zero) {
        if (error) {
            error->offset = result.IsError() ? std::min(int(result.Offset()), json.size())
                                             : int(static_cast<const char *>(zero) - json.constData());
            error->line = 1 + int(std::count(json.begin(), json.begin() + error->offset, '\n'));
            error->message = !result.IsError()             ? QStringLiteral("a zero byte")
                             : builder.complaint.isEmpty() ? parserMessage(result.Code())
                                                           : builder.complaint;
        }
        return std::nullopt;
    }
    return WireValue(made);
}

} // namespace hermes

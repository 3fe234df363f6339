#include "protocol/wire/WireValue.h"

#include <QJsonArray>
#include <QJsonObject>
#include <QVariant>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <rapidjson/document.h>
#include <rapidjson/error/en.h>
#include <string>
#include <string_view>
#include <vector>

namespace hermes {
namespace {

using Node = rapidjson::Value;

const Node &nodeOf(const void *pointer) {
    static const Node none;
    return pointer ? *static_cast<const Node *>(pointer) : none;
}

QString textOf(const Node &node) {
    return QString::fromUtf8(node.GetString(), int(node.GetStringLength()));
}

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

/// Hands what the parser finds on to the document, and stops where it is nested too deeply or a key comes
/// twice.
class Guard : public rapidjson::BaseReaderHandler<rapidjson::UTF8<>, Guard> {
public:
    Guard(rapidjson::Document &target, int depthLimit)
        : document_(target)
        , maximumDepth_(depthLimit) {}

    QString complaint;

    bool Null() { return document_.Null(); }
    bool Bool(bool value) { return document_.Bool(value); }
    /// Its grammar is checked already. What is nearer to 0 than any number is 0.
    bool RawNumber(const char *text, unsigned length, bool) {
        const char *const end = text + length;
        if (const auto decimal = shortDecimal(text, end))
            return document_.Double(*decimal);
        qint64 whole = 0;
        if (const auto read = std::from_chars(text, end, whole); read.ptr == end && read.ec == std::errc())
            return document_.Int64(whole);
        double number = 0;
        if (std::from_chars(text, end, number).ec == std::errc::result_out_of_range &&
            !isSmall({text, length}))
            complaint = QStringLiteral("Number too big to be stored in double.");
        return complaint.isEmpty() && document_.Double(number);
    }
    bool String(const char *text, unsigned length, bool copy) {
        return isWhole(text, length) && document_.String(text, length, copy);
    }
    bool Key(const char *text, unsigned length, bool copy) {
        if (!isWhole(text, length))
            return false;
        keys_.back().emplace_back(text, length);
        return document_.Key(text, length, copy);
    }
    bool StartObject() { return enter() && document_.StartObject(); }
    bool EndObject(unsigned count) { return leave() && document_.EndObject(count); }
    bool StartArray() { return enter() && document_.StartArray(); }
    bool EndArray(unsigned count) {
        keys_.pop_back();
        return document_.EndArray(count);
    }

private:
    static bool isSmall(std::string_view number) {
        const auto exponent = number.find_first_of("eE");
        return exponent == std::string_view::npos ? number.find('.') != std::string_view::npos
                                                  : number[exponent + 1] == '-';
    }

    // The parser lets half of a pair of surrogates pass where it is the second one.
    bool isWhole(const char *text, unsigned length) {
        const char *const end = text + length;
        for (const char *at = text; at != end; ++at) {
            at = static_cast<const char *>(std::memchr(at, 0xED, std::size_t(end - at)));
            if (!at)
                return true;
            if (end - at > 1 && static_cast<unsigned char>(at[1]) >= 0xA0) {
                complaint = QStringLiteral("half of a surrogate pair");
                return false;
            }
        }
        return true;
    }
    bool enter() {
        keys_.emplace_back();
        if (int(keys_.size()) > maximumDepth_)
            complaint = QStringLiteral("nested deeper than %1 levels").arg(maximumDepth_);
        return complaint.isEmpty();
    }

    bool leave() {
        std::vector<std::string> &names = keys_.back();
        std::sort(names.begin(), names.end());
        const auto twice = std::adjacent_find(names.begin(), names.end());
        if (twice != names.end())
            complaint = QStringLiteral("the key \"%1\" occurs twice in one object")
                            .arg(QString::fromStdString(*twice));
        keys_.pop_back();
        return complaint.isEmpty();
    }

    rapidjson::Document &document_;
    const int maximumDepth_;
    std::vector<std::vector<std::string>> keys_; // of each object (or array: none) still open
};

void give(const QJsonValue &value, rapidjson::Document &to) {
    switch (value.type()) {
    case QJsonValue::Bool:
        to.Bool(value.toBool());
        break;
    case QJsonValue::Double:
        if (const QVariant exact = value.toVariant(); exact.type() == QVariant::LongLong)
            to.Int64(exact.toLongLong());
        else
            to.Double(value.toDouble());
        break;
    case QJsonValue::String: {
        const QByteArray text = value.toString().toUtf8();
        to.String(text.constData(), unsigned(text.size()), true);
        break;
    }
    case QJsonValue::Array: {
        const QJsonArray array = value.toArray();
        to.StartArray();
        for (const QJsonValue &element : array)
            give(element, to);
        to.EndArray(unsigned(array.size()));
        break;
    }
    case QJsonValue::Object: {
        const QJsonObject object = value.toObject();
        to.StartObject();
        for (auto member = object.begin(); member != object.end(); ++member) {
            const QByteArray key = member.key().toUtf8();
            to.Key(key.constData(), unsigned(key.size()), true);
            give(member.value(), to);
        }
        to.EndObject(unsigned(object.size()));
        break;
    }
    default:
        to.Null();
    }
}

QJsonValue toJson(const Node &node) {
    switch (node.GetType()) {
    case rapidjson::kFalseType:
    case rapidjson::kTrueType:
        return node.GetBool();
    case rapidjson::kNumberType:
        return node.IsInt64() ? QJsonValue(qint64(node.GetInt64())) : QJsonValue(node.GetDouble());
    case rapidjson::kStringType:
        return textOf(node);
    case rapidjson::kArrayType: {
        QJsonArray array;
        for (const Node &element : node.GetArray())
            array.append(toJson(element));
        return array;
    }
    case rapidjson::kObjectType: {
        std::vector<std::pair<QString, const Node *>> members; // in order: each goes to the end of the object
        members.reserve(node.MemberCount());
        for (const auto &member : node.GetObject())
            members.emplace_back(textOf(member.name), &member.value);
        std::sort(members.begin(), members.end());
        QJsonObject object;
        for (const auto &[name, value] : members)
            object.insert(name, toJson(*value));
        return object;
    }
    default:
        return QJsonValue::Null;
    }
}

template <typename T>
std::size_t copyNumbers(const Node &node, T *to) {
    if (!node.IsArray())
        return 0;
    std::size_t count = 0;
    for (const Node &element : node.GetArray()) {
        if (!element.IsNumber())
            break;
        to[count++] = T(element.GetDouble());
    }
    return count;
}

} // namespace

struct WireValue::Tree {
    QByteArray text; ///< that the strings of the document lie in
    rapidjson::Document document;
};

WireView::Kind WireView::kind() const {
    if (!node_)
        return Kind::Undefined;
    switch (nodeOf(node_).GetType()) {
    case rapidjson::kFalseType:
    case rapidjson::kTrueType:
        return Kind::Boolean;
    case rapidjson::kNumberType:
        return Kind::Number;
    case rapidjson::kStringType:
        return Kind::Text;
    case rapidjson::kArrayType:
        return Kind::Array;
    case rapidjson::kObjectType:
        return Kind::Object;
    default:
        return Kind::Null;
    }
}

bool WireView::boolean() const {
    return nodeOf(node_).IsTrue();
}

double WireView::number() const {
    return nodeOf(node_).IsNumber() ? nodeOf(node_).GetDouble() : std::numeric_limits<double>::quiet_NaN();
}

std::optional<qint64> WireView::integer() const {
    const Node &value = nodeOf(node_);
    if (value.IsInt64())
        return value.GetInt64();
    const double number = this->number();
    if (number == std::floor(number) && std::abs(number) < 9.2e18)
        return qint64(number);
    return std::nullopt;
}

QString WireView::text() const {
    return nodeOf(node_).IsString() ? textOf(nodeOf(node_)) : QString();
}

std::size_t WireView::size() const {
    const Node &value = nodeOf(node_);
    return value.IsArray() ? value.Size() : value.IsObject() ? value.MemberCount() : 0;
}

WireView WireView::operator[](std::size_t element) const {
    const Node &value = nodeOf(node_);
    return value.IsArray() && element < value.Size() ? WireView(&value[unsigned(element)]) : WireView();
}

WireView WireView::operator[](const char *name) const {
    const Node &value = nodeOf(node_);
    if (!value.IsObject())
        return {};
    const auto member = value.FindMember(name);
    return member == value.MemberEnd() ? WireView() : WireView(&member->value);
}

std::size_t WireView::numbers(float *to) const {
    return copyNumbers(nodeOf(node_), to);
}

std::size_t WireView::numbers(double *to) const {
    return copyNumbers(nodeOf(node_), to);
}

void WireView::forEachMember(const std::function<void(const QString &, WireView)> &see) const {
    if (nodeOf(node_).IsObject())
        for (const auto &member : nodeOf(node_).GetObject())
            see(textOf(member.name), WireView(&member.value));
}

QJsonValue WireView::toJson() const {
    return node_ ? hermes::toJson(nodeOf(node_)) : QJsonValue(QJsonValue::Undefined);
}

QString WireView::described() const {
    switch (kind()) {
    case Kind::Undefined:
        return QStringLiteral("nothing");
    case Kind::Null:
        return QStringLiteral("null");
    case Kind::Boolean:
        return boolean() ? QStringLiteral("true") : QStringLiteral("false");
    case Kind::Number:
        return QString::number(number(), 'g', 10);
    case Kind::Text:
        return QStringLiteral("text \"%1\"").arg(text().left(40));
    case Kind::Array:
        return QStringLiteral("an array of %1").arg(size());
    case Kind::Object:
        return QStringLiteral("an object of %1").arg(size());
    }
    return {};
}

WireValue::WireValue(const QJsonValue &value) {
    if (value.isUndefined())
        return;
    const auto made = std::make_shared<Tree>();
    const auto generate = [&value](rapidjson::Document &document) {
        give(value, document);
        return true;
    };
    made->document.Populate(generate);
    node_ = static_cast<const Node *>(&made->document);
    tree_ = made;
}

std::optional<WireValue> WireValue::parse(const QByteArray &json, WireError *error, int maximumDepth) {
    const auto made = std::make_shared<Tree>();
    made->text = json + QByteArray(4, '\0'); // a character that is cut off makes the parser read on
    const void *const zero =
        std::memchr(json.constData(), 0, std::size_t(json.size())); // to the parser the end
    Guard guard(made->document, maximumDepth);
    rapidjson::ParseResult result;
    const auto generate = [&](rapidjson::Document &) {
        rapidjson::InsituStringStream bytes(made->text.data());
        constexpr unsigned flags = rapidjson::kParseInsituFlag | rapidjson::kParseNumbersAsStringsFlag |
                                   rapidjson::kParseValidateEncodingFlag;
        result = rapidjson::Reader().Parse<flags>(bytes, guard);
        return !result.IsError();
    };
    made->document.Populate(generate);
    if (result.IsError() || zero) {
        if (error) {
            error->offset = result.IsError() ? std::min(int(result.Offset()), json.size())
                                             : int(static_cast<const char *>(zero) - json.constData());
            error->line = 1 + int(std::count(json.begin(), json.begin() + error->offset, '\n'));
            error->message = !result.IsError() ? QStringLiteral("a zero byte")
                             : guard.complaint.isEmpty()
                                 ? QString::fromLatin1(rapidjson::GetParseError_En(result.Code()))
                                 : guard.complaint;
        }
        return std::nullopt;
    }
    WireValue value;
    value.node_ = static_cast<const Node *>(&made->document);
    value.tree_ = made;
    return value;
}

} // namespace hermes

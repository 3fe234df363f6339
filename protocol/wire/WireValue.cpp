#include "protocol/wire/WireTree.h"
#include "protocol/wire/WireWriter.h"

#include <QJsonArray>
#include <QJsonObject>
#include <QVariant>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace hermes {
namespace {

const Node &nodeOf(const void *pointer) {
    static const Node none;
    return pointer ? *static_cast<const Node *>(pointer) : none;
}

QString textOf(const Node &node) {
    return QString::fromUtf8(node.GetString(), int(node.GetStringLength()));
}

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

QJsonValue toJson(const PackedNumbers &numbers, std::size_t i) {
    if (const auto whole = numbers.integer(i))
        return *whole;
    const double number = numbers.at(i);
    return std::isfinite(number) ? QJsonValue(number) : QJsonValue();
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
        if (const auto packed = PackedNumbers::of(node)) {
            QJsonArray array;
            for (std::size_t i = 0; i < packed->size(); ++i)
                array.append(toJson(*packed, i));
            return array;
        }
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
void write(const PackedNumbers &numbers, WireWriter &out) {
    std::vector<T> values(numbers.size());
    numbers.copy(values.data());
    for (const T value : values)
        out.number(value);
}

void write(const Node &node, WireWriter &out) {
    switch (node.GetType()) {
    case rapidjson::kFalseType:
    case rapidjson::kTrueType:
        return out.boolean(node.GetBool());
    case rapidjson::kNumberType:
        return node.IsInt64() ? out.integer(node.GetInt64()) : out.number(node.GetDouble());
    case rapidjson::kStringType:
        return out.text(textOf(node));
    case rapidjson::kArrayType:
        out.beginArray();
        for (const Node &element : node.GetArray())
            write(element, out);
        return out.endArray();
    case rapidjson::kObjectType:
        if (const auto packed = PackedNumbers::of(node)) {
            out.beginArray();
            packed->kind == PackedNumbers::Kind::Float ? write<float>(*packed, out)
                                                       : write<double>(*packed, out);
            return out.endArray();
        }
        out.beginObject();
        for (const auto &member : node.GetObject()) {
            out.key(textOf(member.name));
            write(member.value, out);
        }
        return out.endObject();
    default:
        out.null();
    }
}

template <typename T>
std::size_t copyNumbers(const Node &node, T *to) {
    if (const auto packed = PackedNumbers::of(node))
        return packed->copy(to);
    if (!node.IsArray())
        return 0;
    std::size_t count = 0;
    for (const Node &element : node.GetArray()) {
        if constexpr (std::is_floating_point_v<T>) {
            if (!element.IsNumber())
                break;
            to[count++] = T(element.GetDouble());
        } else {
            if (!element.IsInt() || element.GetInt() < 0 || element.GetInt() > std::numeric_limits<T>::max())
                break;
            to[count++] = T(element.GetInt());
        }
    }
    return count;
}

} // namespace

WireView::Kind WireView::kind() const {
    if (!node_)
        return Kind::Undefined;
    if (element_)
        return Kind::Number;
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
        return PackedNumbers::of(nodeOf(node_)) ? Kind::Array : Kind::Object;
    default:
        return Kind::Null;
    }
}

bool WireView::boolean() const {
    return nodeOf(node_).IsTrue();
}

double WireView::number() const {
    if (element_)
        return PackedNumbers::of(nodeOf(node_))->at(*element_);
    return nodeOf(node_).IsNumber() ? nodeOf(node_).GetDouble() : std::numeric_limits<double>::quiet_NaN();
}

std::optional<qint64> WireView::integer() const {
    const Node &value = nodeOf(node_);
    if (element_)
        return PackedNumbers::of(value)->integer(*element_);
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
    if (const auto packed = PackedNumbers::of(value))
        return element_ ? 0 : packed->size();
    return value.IsArray() ? value.Size() : value.IsObject() ? value.MemberCount() : 0;
}

WireView WireView::operator[](std::size_t element) const {
    const Node &value = nodeOf(node_);
    if (const auto packed = PackedNumbers::of(value))
        return !element_ && element < packed->size() ? WireView(node_, element) : WireView();
    return value.IsArray() && element < value.Size() ? WireView(&value[unsigned(element)]) : WireView();
}

WireView WireView::operator[](const char *name) const {
    const Node &value = nodeOf(node_);
    if (!value.IsObject() || PackedNumbers::of(value))
        return {};
    const auto member = value.FindMember(name);
    return member == value.MemberEnd() ? WireView() : WireView(&member->value);
}

std::size_t WireView::numbers(float *to) const {
    return element_ ? 0 : copyNumbers(nodeOf(node_), to);
}

std::size_t WireView::numbers(double *to) const {
    return element_ ? 0 : copyNumbers(nodeOf(node_), to);
}

std::size_t WireView::numbers(quint8 *to) const {
    return element_ ? 0 : copyNumbers(nodeOf(node_), to);
}

std::size_t WireView::numbers(quint16 *to) const {
    return element_ ? 0 : copyNumbers(nodeOf(node_), to);
}

void WireView::forEachMember(const std::function<void(const QString &, WireView)> &see) const {
    if (nodeOf(node_).IsObject() && !PackedNumbers::of(nodeOf(node_)))
        for (const auto &member : nodeOf(node_).GetObject())
            see(textOf(member.name), WireView(&member.value));
}

QJsonValue WireView::toJson() const {
    if (element_)
        return hermes::toJson(*PackedNumbers::of(nodeOf(node_)), *element_);
    return node_ ? hermes::toJson(nodeOf(node_)) : QJsonValue(QJsonValue::Undefined);
}

void WireView::write(WireWriter &out) const {
    if (element_)
        out.number(PackedNumbers::of(nodeOf(node_))->at(*element_));
    else
        hermes::write(nodeOf(node_), out);
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
        return QString("text \"%1\"").arg(text().left(40));
    case Kind::Array:
        return QString("an array of %1").arg(size());
    case Kind::Object:
        return QString("an object of %1").arg(size());
    }
    return {};
}

WireValue::WireValue(const std::shared_ptr<const Tree> &whole)
    : WireView(static_cast<const Node *>(&whole->document))
    , tree_(whole) {}

WireValue::WireValue(const QJsonValue &value) {
    if (value.isUndefined())
        return;
    const auto made = std::make_shared<Tree>();
    const auto generate = [&value](rapidjson::Document &document) {
        give(value, document);
        return true;
    };
    made->document.Populate(generate);
    *this = WireValue(made);
}

} // namespace hermes

#include "protocol/wire/WireWriter.h"

#include <QJsonArray>
#include <QJsonObject>
#include <QVariant>

namespace hermes {

template <typename T>
void WireWriter::each(const T *values, std::size_t count) {
    beginArray();
    for (std::size_t i = 0; i < count && !isRefused_; ++i) {
        if constexpr (std::is_integral_v<T>)
            integer(values[i]);
        else
            number(values[i]);
        if (isRefused_)
            within(QString::number(i));
    }
    endArray();
}

void WireWriter::numbers(const float *values, std::size_t count) {
    each(values, count);
}

void WireWriter::numbers(const double *values, std::size_t count) {
    each(values, count);
}

void WireWriter::numbers(const quint8 *values, std::size_t count) {
    each(values, count);
}

void WireWriter::numbers(const quint16 *values, std::size_t count) {
    each(values, count);
}

void WireWriter::json(const QJsonValue &value) {
    switch (value.type()) {
    case QJsonValue::Bool:
        return boolean(value.toBool());
    case QJsonValue::Double:
        if (const QVariant exact = value.toVariant(); exact.type() == QVariant::LongLong)
            return integer(exact.toLongLong());
        return number(value.toDouble());
    case QJsonValue::String:
        return text(value.toString());
    case QJsonValue::Array: {
        beginArray();
        int i = 0;
        for (const QJsonValue &element : value.toArray())
            json(element, QString::number(i++));
        return endArray();
    }
    case QJsonValue::Object: {
        beginObject();
        const QJsonObject object = value.toObject();
        for (auto member = object.begin(); member != object.end(); ++member) {
            key(member.key());
            json(member.value(), member.key());
        }
        return endObject();
    }
    default:
        return null();
    }
}

void WireWriter::json(const QJsonValue &value, const QString &name) {
    const bool before = isRefused_;
    json(value);
    if (isRefused_ && !before)
        within(name);
}

} // namespace hermes

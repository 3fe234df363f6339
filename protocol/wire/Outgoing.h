#pragma once

#include "protocol/wire/FieldsOf.h"
#include "protocol/wire/WireWriter.h"

#include <QJsonArray>
#include <QJsonObject>
#include <functional>
#include <memory>

namespace hermes {

/// A message on its way out: turned into bytes when somebody wants them. Cheap to copy.
class Outgoing {
public:
    /// Nothing, as an undefined QJsonValue.
    Outgoing() = default;
    Outgoing(const QJsonValue &value) {
        if (!value.isUndefined())
            writer_ = [value](WireWriter &out) { out.json(value); };
    }
    /// A struct with fields, a list of them, or what QJsonValue is made from.
    template <typename T, typename = std::enable_if_t<!std::is_same_v<std::decay_t<T>, Outgoing>>>
    Outgoing(T message) {
        if constexpr (std::is_convertible_v<T, QJsonValue>)
            *this = Outgoing(QJsonValue(message));
        else
            writer_ = [held = std::make_shared<const T>(std::move(message))](WireWriter &out) {
                Type<T>::write(out, *held);
            };
    }
    static Outgoing writtenBy(std::function<void(WireWriter &)> write) {
        Outgoing made;
        made.writer_ = std::move(write);
        return made;
    }

    bool isNothing() const { return !writer_; }
    void write(WireWriter &out) const { writer_ ? writer_(out) : out.null(); }

private:
    std::function<void(WireWriter &)> writer_;
};

} // namespace hermes

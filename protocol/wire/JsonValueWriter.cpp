#include "protocol/wire/JsonValueWriter.h"

#include <charconv>

namespace hermes {

void JsonValueWriter::finite(float value) {
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, value).ptr;
    double shortest = 0;
    std::from_chars(text, end, shortest);
    put(shortest);
}

void JsonValueWriter::put(const QJsonValue &value) {
    if (open_.empty())
        root_ = value;
    else if (open_.back().isObject)
        open_.back().object.insert(open_.back().key, value);
    else
        open_.back().array.append(value);
}

void JsonValueWriter::close() {
    const Level level = std::move(open_.back());
    open_.pop_back();
    put(level.isObject ? QJsonValue(level.object) : QJsonValue(level.array));
}

} // namespace hermes

#pragma once

#include <QByteArray>
#include <optional>

namespace hermes {

/// Consistent Overhead Byte Stuffing (Cheshire and Baker, 1999): the bytes without a zero among them, so that
/// a zero can end them. One byte longer, and one more for each 254.
QByteArray cobsEncoded(const QByteArray &bytes);

/// What cobsEncoded() was given; nothing when these bytes cannot come from it.
std::optional<QByteArray> cobsDecoded(const char *bytes, int size);

} // namespace hermes

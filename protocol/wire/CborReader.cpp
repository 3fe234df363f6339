#include "protocol/wire/CborWriter.h"

#include <QCborStreamReader>
#include <QtEndian>
#include <algorithm>
#include <cmath>
#include <cstring>

namespace hermes {
namespace {

using Kind = PackedNumbers::Kind;

/// A kind of typed array, and whether its bytes are in the order of the other machines.
struct TypedArray {
    Kind kind;
    bool isSwapped;
};

std::optional<TypedArray> typedArray(quint64 tag) {
    for (int kind = 0; kind <= int(Kind::Double); ++kind) {
        const quint64 own = typedArrayTag(Kind(kind));
        if (tag == own)
            return TypedArray{Kind(kind), false};
        if (tag == (own ^ 4) && PackedNumbers::sizeOf(Kind(kind)) > 1)
            return TypedArray{Kind(kind), true};
    }
    constexpr quint64 clampedBytes = 68;
    return tag == clampedBytes ? std::optional(TypedArray{Kind::UInt8, false}) : std::nullopt;
}

template <typename T>
bool areFinite(const char *bytes, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        T value;
        std::memcpy(&value, bytes + i * sizeof(T), sizeof(T));
        if (!std::isfinite(value))
            return false;
    }
    return true;
}

bool areFinite(Kind kind, const char *bytes, std::size_t size) {
    return kind == Kind::Float    ? areFinite<float>(bytes, size / sizeof(float))
           : kind == Kind::Double ? areFinite<double>(bytes, size / sizeof(double))
                                  : true;
}

/// Hands an item on to the tree.
class CborReader {
public:
    /// room: for packed numbers; it holds as many bytes as the item, so that they stay where they are.
    CborReader(QCborStreamReader &in, qsizetype size, QByteArray &room, TreeBuilder &tree)
        : in_(in)
        , size_(size)
        , room_(room)
        , tree_(tree) {}

    bool readItem() {
        std::optional<TypedArray> array;
        for (; isFine() && in_.isTag(); in_.next())
            array = typedArray(quint64(in_.toTag()));
        if (in_.isByteArray())
            return readBytes(array);
        return in_.isContainer() ? readContainer() : in_.isString() ? readText(false) : readSimple();
    }

private:
    bool refuse(const QString &why) {
        if (tree_.complaint.isEmpty())
            tree_.complaint = why;
        return false;
    }
    bool isFine() const { return in_.lastError() == QCborError::NoError; }
    bool broken() { return refuse(in_.lastError().toString()); }

    bool readSimple() {
        bool isTaken = false;
        if (in_.isUnsignedInteger())
            isTaken = whole(in_.toUnsignedInteger());
        else if (in_.isNegativeInteger())
            isTaken = negative(quint64(in_.toNegativeInteger()));
        else if (in_.isFloat())
            isTaken = number(double(in_.toFloat()));
        else if (in_.isDouble())
            isTaken = number(in_.toDouble());
        else if (in_.isFloat16())
            isTaken = number(double(float(in_.toFloat16())));
        else if (in_.isBool())
            isTaken = tree_.Bool(in_.toBool());
        else if (in_.isNull())
            isTaken = tree_.Null();
        else
            return in_.isInvalid() ? broken() : refuse(QStringLiteral("a value that JSON does not have"));
        return isTaken && (in_.next() || broken());
    }

    /// Before room is made for it.
    bool isCut() {
        const qint64 rest = size_ - in_.currentOffset();
        if (in_.currentStringChunkSize() <= rest)
            return false;
        return !refuse(
            QString("%1 bytes of text expected, there are %2").arg(in_.currentStringChunkSize()).arg(rest));
    }

    bool whole(quint64 value) {
        return value <= quint64(std::numeric_limits<qint64>::max()) ? tree_.Int64(qint64(value))
                                                                    : tree_.Double(double(value));
    }
    /// below: so much below 0; 0 stands for 2^64.
    bool negative(quint64 below) {
        return below != 0 && below <= quint64(1) << 63
                   ? tree_.Int64(qint64(0 - below))
                   : tree_.Double(below == 0 ? -std::ldexp(1, 64) : -double(below));
    }
    bool number(double value) {
        return std::isfinite(value) ? tree_.Double(value)
                                    : refuse(QStringLiteral("a number that is not finite"));
    }

    bool readText(bool isKey) {
        QByteArray text;
        if (isCut())
            return false;
        auto chunk = in_.readString();
        for (; chunk.status == QCborStreamReader::Ok && !isCut(); chunk = in_.readString())
            text += chunk.data.toUtf8();
        if (!tree_.complaint.isEmpty())
            return false;
        if (chunk.status == QCborStreamReader::Error)
            return broken();
        return isKey ? tree_.Key(text.constData(), unsigned(text.size()), true)
                     : tree_.String(text.constData(), unsigned(text.size()), true);
    }

    bool readBytes(const std::optional<TypedArray> &array) {
        if (!array)
            return refuse(QStringLiteral(
                "bytes, expected a typed array of integers, floats or doubles where there are bytes"));
        const int begin = room_.size();
        for (;;) {
            const qsizetype size = in_.currentStringChunkSize();
            if (size > size_ - room_.size())
                return refuse(QString("a typed array of %1 bytes, more than there are").arg(size));
            const int at = room_.size();
            if (size > 0)
                room_.resize(at + int(size));
            const auto chunk = in_.readStringChunk(room_.data() + at, std::max<qsizetype>(size, 0));
            if (chunk.status == QCborStreamReader::Error)
                return broken();
            if (chunk.status == QCborStreamReader::EndOfString)
                break;
        }
        const auto bytes = std::size_t(room_.size() - begin);
        const std::size_t each = PackedNumbers::sizeOf(array->kind);
        if (bytes % each != 0)
            return refuse(
                QString("a typed array of %1 bytes, expected a multiple of %2").arg(bytes).arg(each));
        char *const first = room_.data() + begin;
        if (array->isSwapped)
            for (std::size_t i = 0; i < bytes; i += each)
                std::reverse(first + i, first + i + each);
        if (!areFinite(array->kind, first, bytes))
            return refuse(QStringLiteral("a number that is not finite"));
        return tree_.packed(array->kind, first, unsigned(bytes));
    }

    bool readContainer() {
        const bool isMap = in_.isMap();
        if (!(isMap ? tree_.StartObject() : tree_.StartArray()))
            return false;
        if (!in_.enterContainer())
            return broken();
        unsigned count = 0;
        // What comes after a text may be broken although the text was whole.
        for (; isFine() && in_.hasNext(); ++count) {
            if (isMap && !in_.isString())
                return in_.isInvalid() ? broken() : refuse(QStringLiteral("a key that is no text"));
            if (isMap && !readText(true))
                return false;
            if (!readItem())
                return false;
        }
        if (!isFine() || !in_.leaveContainer())
            return broken();
        return isMap ? tree_.EndObject(count) : tree_.EndArray(count);
    }

    QCborStreamReader &in_;
    const qsizetype size_;
    QByteArray &room_;
    TreeBuilder &tree_;
};

} // namespace

std::optional<WireValue> WireValue::parseCbor(const QByteArray &cbor, WireError *error,
                                              const WireLimits &limits) {
    const auto made = std::make_shared<Tree>();
    made->text.reserve(cbor.size());
    TreeBuilder tree(made->document, limits);
    QCborStreamReader in(cbor);
    bool isRead = false;
    const auto generate = [&](rapidjson::Document &) {
        isRead = CborReader(in, cbor.size(), made->text, tree).readItem();
        if (isRead && in.currentOffset() < cbor.size()) {
            isRead = false;
            tree.complaint = QStringLiteral("bytes after the value");
        }
        return isRead;
    };
    made->document.Populate(generate);
    if (!isRead) {
        if (error)
            *error = {tree.complaint.isEmpty() ? QStringLiteral("not CBOR") : tree.complaint,
                      int(std::clamp<qint64>(in.currentOffset(), 0, cbor.size())), 1};
        return std::nullopt;
    }
    return WireValue(made);
}

} // namespace hermes

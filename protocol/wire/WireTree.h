#pragma once

#include "protocol/wire/WireValue.h"

#include <rapidjson/document.h>
#include <string>
#include <vector>

// What the readers of JSON and CBOR, and the views of what they read, share.
namespace hermes {

using Node = rapidjson::Value;

/// Numbers of one kind, one after another, as CBOR has them; in the byte order of this machine. In the tree
/// they are an object with one member, whose name lies in names[]: its place there, not its text, is the
/// kind, and no message can have that.
struct PackedNumbers {
    enum class Kind { UInt8, UInt16, UInt32, UInt64, Int8, Int16, Int32, Int64, Float, Double };
    static constexpr char names[] = "0123456789";

    Kind kind;
    const char *bytes;
    std::size_t byteCount;

    static std::size_t sizeOf(Kind kind);
    /// Nothing: the node is something else.
    static std::optional<PackedNumbers> of(const Node &node);

    std::size_t size() const { return byteCount / sizeOf(kind); }
    double at(std::size_t i) const;
    /// When it is a whole number that fits.
    std::optional<qint64> integer(std::size_t i) const;
    /// As many as T can hold.
    template <typename T>
    std::size_t copy(T *to) const;
};

/// Takes what a parser finds into the document, and stops where it is nested too deeply, a key comes twice,
/// or there are too many values: each takes far more memory than it has bytes.
class TreeBuilder {
public:
    TreeBuilder(rapidjson::Document &target, const WireLimits &limits)
        : document_(target)
        , limits_(limits) {}

    /// What is wrong; empty: nothing.
    QString complaint;

    bool Null() { return count() && document_.Null(); }
    bool Bool(bool value) { return count() && document_.Bool(value); }
    bool Int64(qint64 value) { return count() && document_.Int64(value); }
    bool Double(double value) { return count() && document_.Double(value); }
    bool String(const char *text, unsigned length, bool copy);
    bool Key(const char *text, unsigned length, bool copy);
    bool StartObject() { return enter() && document_.StartObject(); }
    bool EndObject(unsigned count) { return leave() && document_.EndObject(count); }
    bool StartArray() { return enter() && document_.StartArray(); }
    bool EndArray(unsigned count);
    /// bytes stay where they are.
    bool packed(PackedNumbers::Kind kind, const char *bytes, unsigned byteCount);

protected:
    rapidjson::Document &document_;

private:
    bool isWhole(const char *text, unsigned length);
    bool count();
    bool enter();
    bool leave();

    const WireLimits limits_;
    int values_ = 0;
    std::vector<std::vector<std::string>> keys_; // of each object (or array: none) still open
};

struct WireValue::Tree {
    QByteArray text; ///< that strings and packed numbers of the document lie in
    rapidjson::Document document;
};

} // namespace hermes

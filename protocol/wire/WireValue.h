#pragma once

#include <QByteArray>
#include <QJsonValue>
#include <QString>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>

namespace hermes {

class WireWriter;

/// A value of a message that came, whatever form it had on the wire: a view into a tree that somebody else
/// keeps alive.
class WireView {
public:
    enum class Kind { Undefined, Null, Boolean, Number, Text, Array, Object };

    WireView() = default;

    Kind kind() const;
    bool boolean() const;  ///< false when it is none
    double number() const; ///< NaN when it is none
    /// When it is a whole number that fits.
    std::optional<qint64> integer() const;
    QString text() const;     ///< empty when it is none
    std::size_t size() const; ///< elements or members; 0 when it has none
    WireView operator[](std::size_t element) const;
    WireView operator[](const char *member) const; ///< undefined when there is none
    /// As many numbers of the array as come one after another from its beginning; at most size().
    std::size_t numbers(float *to) const;
    std::size_t numbers(double *to) const;
    std::size_t numbers(quint8 *to) const;
    std::size_t numbers(quint16 *to) const;
    void forEachMember(const std::function<void(const QString &name, WireView value)> &see) const;
    QJsonValue toJson() const;
    /// To a writer of any form; members in the order in which they came.
    void write(WireWriter &out) const;
    /// For an error message: `text "abc"`, `12`, `an array of 3`.
    QString described() const;

protected:
    explicit WireView(const void *tree, std::optional<std::size_t> element = std::nullopt)
        : node_(tree)
        , element_(element) {}

private:
    friend class WireValue;

    const void *node_ = nullptr;
    std::optional<std::size_t> element_; // of packed numbers
};

/// What is wrong with a text, and where.
struct WireError {
    QString message;
    int offset = 0; ///< byte, from 0
    int line = 1;   ///< from 1
};

/// What a text may hold: each value takes far more memory than it has bytes.
struct WireLimits {
    int depth = 100;
    int values = 2000000; ///< a map of 100,000 edges has some 1,300,000
};

/// A value that keeps its tree alive. Cheap to copy.
class WireValue : public WireView {
public:
    WireValue() = default; ///< undefined
    WireValue(const QJsonValue &value);
    /// Part of another one's tree.
    WireValue(const WireValue &whole, WireView part)
        : WireView(part)
        , tree_(whole.tree_) {}

    /// Strict JSON: any value may stand at the top, bytes must be UTF-8, a key may occur once in an object,
    /// nesting is limited. Nothing: error says why.
    static std::optional<WireValue> parse(const QByteArray &json, WireError *error,
                                          const WireLimits &limits = {});

    /// One item of CBOR (RFC 8949) that JSON could hold, too; arrays of numbers may be typed arrays (RFC
    /// 8746) of integers, floats and doubles in either byte order. Limits and errors as of parse().
    static std::optional<WireValue> parseCbor(const QByteArray &cbor, WireError *error,
                                              const WireLimits &limits = {});

private:
    struct Tree;

    explicit WireValue(const std::shared_ptr<const Tree> &whole);

    std::shared_ptr<const Tree> tree_;
};

} // namespace hermes

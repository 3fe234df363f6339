#pragma once

#include "protocol/ros/Common.h"

#include "vectorlib/error/Result.h"

#include <cstring>
#include <string_view>

namespace hermes::ros {

/// The value, or a line that says what is wrong with the bytes.
template <typename T>
using Outcome = vectorlib::Result<T, std::string>;

/// CDR: as ROS 2 sends it (XCDR1). Ros1: as ROS 1 does, with no gaps, and a number in each header.
enum class Form { Cdr, Ros1 };

/// Appends the bytes of messages, little-endian.
template <Form form>
class Writer {
public:
    /// Positions are aligned from the end of what out has.
    explicit Writer(std::string &out)
        : out_(out)
        , begin_(out.size()) {}

    template <typename T>
    void write(const T &value) {
        using Element = typename Elements<T>::Element;
        if constexpr (isPlain<T>) {
            plain(&value, 1, sizeof(T));
        } else if constexpr (std::is_same_v<T, std::string>) {
            count(value.size() + (form == Form::Cdr));
            out_.append(value.data(), value.size());
            if constexpr (form == Form::Cdr)
                out_.push_back('\0');
        } else if constexpr (!std::is_void_v<Element>) {
            if constexpr (std::is_same_v<T, std::vector<Element>>)
                count(value.size());
            if constexpr (isPlain<Element>)
                plain(value.data(), value.size(), sizeof(Element));
            else
                for (const Element &element : value)
                    write(element);
        } else {
            if constexpr (form == Form::Ros1 && std::is_same_v<T, Header>)
                count(0); // seq: nobody uses it
            forEachField(value, [this](const char *, const auto &member) { write(member); });
            if constexpr (form == Form::Cdr && hasNoFields<T>)
                write(Octet());
        }
    }

private:
    void count(std::size_t number) {
        const std::uint32_t narrow = std::uint32_t(number);
        plain(&narrow, 1, sizeof narrow);
    }
    void plain(const void *values, std::size_t many, std::size_t size) {
        if (many == 0)
            return;
        if constexpr (form == Form::Cdr)
            out_.append((size - (out_.size() - begin_) % size) % size, '\0');
        out_.append(static_cast<const char *>(values), many * size);
    }

    std::string &out_;
    const std::size_t begin_;
};

/// Reads messages from bytes that may be anything. It takes no more memory than a small multiple of them.
template <Form form>
class Reader {
public:
    /// isSwapped: numbers are big-endian.
    explicit Reader(std::string_view bytes, bool isSwapped = false)
        : bytes_(bytes)
        , isSwapped_(isSwapped) {}

    template <typename T>
    void read(T &value) {
        using Element = typename Elements<T>::Element;
        if constexpr (isPlain<T>) {
            plain(&value, 1);
        } else if constexpr (std::is_same_v<T, std::string>) {
            text(value);
        } else if constexpr (!std::is_void_v<Element>) {
            if constexpr (std::is_same_v<T, std::vector<Element>>)
                sequence(value);
            else if constexpr (isPlain<Element>)
                plain(value.data(), value.size());
            else
                for (Element &element : value)
                    read(element);
        } else {
            if constexpr (form == Form::Ros1 && std::is_same_v<T, Header>)
                count();
            if constexpr (form == Form::Cdr && hasNoFields<T>) {
                Octet none{};
                plain(&none, 1);
            }
            forEachField(value, [this](const char *name, auto &member) {
                if (!hasFailed())
                    read(member);
                if (hasFailed() && !isNamed_) {
                    problem_.insert(0, std::string(name) + ": ");
                    isNamed_ = true;
                }
            });
        }
    }

    bool hasFailed() const { return !problem_.empty(); }
    const std::string &problem() const { return problem_; } ///< the field, and where
    std::size_t position() const { return at_; }

private:
    void fail(std::size_t needed) {
        if (!hasFailed())
            problem_ = "at byte " + std::to_string(at_) + " of " + std::to_string(bytes_.size()) +
                       ": expected " + std::to_string(needed) + " more";
    }
    bool has(std::size_t needed) {
        if (!hasFailed() && bytes_.size() - at_ < needed)
            fail(needed);
        return !hasFailed();
    }
    template <typename T>
    void align() {
        if constexpr (form == Form::Cdr) {
            const std::size_t gap = (sizeof(T) - at_ % sizeof(T)) % sizeof(T);
            if (has(gap))
                at_ += gap;
        }
    }
    template <typename T>
    void plain(T *values, std::size_t many) {
        if (many == 0)
            return;
        align<T>();
        if (!has(many * sizeof(T)))
            return;
        if constexpr (std::is_same_v<T, bool>) {
            for (std::size_t i = 0; i < many; ++i)
                values[i] = bytes_[at_ + i] != 0; // any other bit pattern is none of bool
        } else {
            std::memcpy(values, bytes_.data() + at_, many * sizeof(T));
            if constexpr (sizeof(T) > 1)
                if (isSwapped_)
                    for (std::size_t i = 0; i < many; ++i)
                        swap(values[i]);
        }
        at_ += many * sizeof(T);
    }
    template <typename T>
    static void swap(T &value) {
        char bytes[sizeof(T)];
        std::memcpy(bytes, &value, sizeof(T));
        for (std::size_t i = 0; i < sizeof(T) / 2; ++i)
            std::swap(bytes[i], bytes[sizeof(T) - 1 - i]);
        std::memcpy(&value, bytes, sizeof(T));
    }
    std::uint32_t count() {
        std::uint32_t number = 0;
        plain(&number, 1);
        return hasFailed() ? 0 : number;
    }
    void text(std::string &value) {
        std::size_t length = count();
        if (!has(length))
            return;
        value.assign(bytes_.data() + at_, length);
        at_ += length;
        if constexpr (form == Form::Cdr) {
            if (length != 0 && value.back() != '\0')
                problem_ = "at byte " + std::to_string(at_) + ": a text without its end";
            else if (length != 0)
                value.pop_back();
        }
    }
    template <typename Element>
    void sequence(std::vector<Element> &values) {
        const std::size_t many = count();
        values.clear();
        if constexpr (isPlain<Element>) {
            if (!has(many * sizeof(Element)))
                return;
            values.resize(many);
            plain(values.data(), many);
        } else {
            for (std::size_t i = 0; i < many && has(1);
                 ++i) // as many as there are bytes for, whatever it says
                read(values.emplace_back());
        }
    }

    const std::string_view bytes_;
    const bool isSwapped_;
    std::size_t at_ = 0;
    std::string problem_;
    bool isNamed_ = false;
};

} // namespace hermes::ros

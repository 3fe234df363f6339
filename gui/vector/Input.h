#pragma once

#include "common/platform/Program.h"
#include "vectorlib/geometry/Vector2D.h"

#include <istream>
#include <memory>
#include <string>
#include <vector>

namespace hermes::vector {

/// Where the worlds are that came with this program; empty when that cannot be told.
inline std::filesystem::path installedWorlds() {
    const std::filesystem::path program = programFile();
    return program.empty() ? program : program.parent_path().parent_path() / "share" / "hermes" / "worlds";
}

/// The file of a world: the one at this path, else the installed one of this name. Throws Failure, which
/// tells the installed names, when there is neither.
std::string worldFile(const std::string &nameOrPath);

/// A file to read, plain or gzip-compressed, or standard input for `-`. A file that breaks off in the middle
/// of its compressed data makes the stream bad instead of ending it. Reading tells its progress.
class Input {
public:
    /// Throws Failure when there is no such file or it is a folder.
    explicit Input(const std::string &path);
    ~Input();

    std::istream &stream() { return stream_; }
    /// How messages call it.
    const std::string &name() const { return name_; }
    /// Whether it begins like a pcap or pcapng capture, plain or compressed. Asked before anything is read,
    /// and reads nothing: a pipe can be read only once.
    bool isCapture();
    /// Everything that is left, as one text; throws Failure over `limit` bytes.
    std::string readAll(std::size_t limit = std::size_t(256) << 20);

private:
    class Buffer;
    std::string name_;
    std::unique_ptr<Buffer> buffer_;
    std::istream stream_;
};

/// A text as a stream, which tells how far it is read.
class TextStream : public std::istream {
public:
    explicit TextStream(std::string text);
    ~TextStream() override;

private:
    class Buffer;
    std::unique_ptr<Buffer> buffer_;
};

/// Whether the path ends with the extension (with dot, lower case), a further .gz left aside; case does not
/// matter.
bool hasExtension(const std::string &path, const std::string &extension);

/// The points of a CSV or (by extension .pcd) PCD file in their order; metres. Throws Failure.
std::vector<vectorlib::Vector2D<double>> loadPoints(const std::string &path);

/// The whole text of a file of one scan that was opened as path. Throws Failure that says how to take a scan
/// out, when it is a CARMEN log or a capture.
std::string readScanText(Input &input, const std::string &path);

} // namespace hermes::vector

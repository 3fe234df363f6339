#pragma once

#include <string>
#include <vector>

namespace hermes::bag {

/// What metadata.yaml tells of a bag of ROS 2.
struct Metadata {
    bool isBag = false;             ///< it is that of a bag
    std::vector<std::string> files; ///< names without folders, in order
    std::string compression;        ///< "zstd", another, or empty: none
};

/// Reads the lines that are needed; all other YAML is passed over.
Metadata readMetadata(const std::string &yaml);

} // namespace hermes::bag

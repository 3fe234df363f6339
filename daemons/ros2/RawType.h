#pragma once

#include <string>
#include <string_view>

struct ddsi_serdata;
struct ddsi_sertype;

namespace hermes::ros2 {

// A DDS type whose samples are bytes: Cyclone knows the type's name and nothing more. All that uses the
// inside of Cyclone DDS (0.10) is in this pair of files.

/// For dds_create_topic_sertype, which takes it over. No keys; the representation is XCDR1.
ddsi_sertype *newRawType(const std::string &name);

/// A sample for dds_writecdr, which takes it over. cdr: with the four bytes of its encapsulation.
ddsi_serdata *newRawSample(const ddsi_sertype *type, std::string_view cdr);

/// The bytes of a sample that dds_takecdr gave, with their encapsulation; valid until releaseRawSample().
std::string_view bytesOf(const ddsi_serdata *sample);
void releaseRawSample(ddsi_serdata *sample);

} // namespace hermes::ros2

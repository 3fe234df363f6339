#include "protocol/ros/Definition.h"

namespace hermes::ros {
namespace {

/// "std_msgs/Header": as .msg texts name it.
std::string shortType(const std::string &type) {
    const std::size_t middle = type.find("/msg/");
    return middle == std::string::npos ? type : type.substr(0, middle) + type.substr(middle + 4);
}

std::string fieldLines(const std::vector<Member> &members) {
    std::string text;
    for (const Member &member : members) {
        text += shortType(member.type);
        if (member.isSequence)
            text += "[]";
        else if (member.length != 0)
            text += '[' + std::to_string(member.length) + ']';
        text += ' ' + member.name + '\n';
    }
    return text;
}

/// type_description_interfaces/msg/FieldType: of one value; 48 more for an array, 144 for a sequence.
int typeNumber(const Member &member) {
    static const std::map<std::string, int> numbers = {
        {"int8", 2},   {"uint8", 3}, {"int16", 4},   {"uint16", 5},   {"int32", 6},
        {"uint32", 7}, {"int64", 8}, {"uint64", 9},  {"float32", 10}, {"float64", 11},
        {"bool", 15},  {"byte", 16}, {"string", 17},
    };
    const auto found = numbers.find(member.type);
    const int number = found == numbers.end() ? 1 : found->second;
    return number + (member.isSequence ? 144 : member.length != 0 ? 48 : 0);
}

std::string described(const std::string &type, const std::vector<Member> &members) {
    std::string text = "{\"type_name\": \"" + type + "\", \"fields\": [";
    for (std::size_t i = 0; i < members.size(); ++i) {
        const Member &member = members[i];
        const bool isMessage = member.type.find('/') != std::string::npos;
        text += std::string(i == 0 ? "" : ", ") + "{\"name\": \"" + member.name +
                "\", \"type\": {\"type_id\": " + std::to_string(typeNumber(member)) +
                ", \"capacity\": " + std::to_string(member.length) +
                ", \"string_capacity\": 0, \"nested_type_name\": \"" + (isMessage ? member.type : "") +
                "\"}}";
    }
    return text + "]}";
}

} // namespace

std::string definitionText(const std::string &type, const Members &members) {
    std::string text = fieldLines(members.at(type));
    for (const auto &[other, fields] : members)
        if (other != type)
            text += std::string(80, '=') + "\nMSG: " + shortType(other) + '\n' + fieldLines(fields);
    return text;
}

std::string hashedText(const std::string &type, const Members &members) {
    std::string text = "{\"type_description\": " + described(type, members.at(type)) +
                       ", \"referenced_type_descriptions\": [";
    bool isFirst = true;
    for (const auto &[other, fields] : members)
        if (other != type) {
            text += (isFirst ? "" : ", ") + described(other, fields);
            isFirst = false;
        }
    return text + "]}";
}

std::string ddsType(const std::string &type) {
    std::string name;
    for (const char c : type.substr(0, type.rfind('/')))
        name += c == '/' ? std::string("::") : std::string(1, c);
    return name + "::dds_::" + type.substr(type.rfind('/') + 1) + '_';
}

} // namespace hermes::ros

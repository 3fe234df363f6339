#include "daemons/web/FoxgloveSchemas.h"

#include <QJsonArray>
#include <QMap>

namespace hermes::web {
namespace {

/// Members of each object as NAME:TYPE; a type with * is a list. Of `none` Hermes never sends one.
const QMap<QString, const char *> shapes{
    {"time", "sec:whole nsec:whole"},
    {"vector", "x:number y:number z:number"},
    {"rotation", "x:number y:number z:number w:number"},
    {"pose", "position:vector orientation:rotation"},
    {"color", "r:number g:number b:number a:number"},
    {"none", ""},
    {"transform", "timestamp:time parent_frame_id:text child_frame_id:text translation:vector "
                  "rotation:rotation"},
    {"FrameTransforms", "transforms:transform*"},
    {"PoseInFrame", "timestamp:time frame_id:text pose:pose"},
    {"field", "name:text offset:whole type:whole"},
    {"PointCloud", "timestamp:time frame_id:text pose:pose point_stride:whole fields:field* data:bytes"},
    {"lines", "type:whole pose:pose thickness:number scale_invariant:flag points:vector* color:color "
              "colors:color* indices:whole*"},
    {"pair", "key:text value:text"},
    {"entity", "timestamp:time frame_id:text id:text lifetime:time frame_locked:flag metadata:pair* "
               "arrows:none* cubes:none* spheres:none* cylinders:none* lines:lines* triangles:none* "
               "texts:none* models:none*"},
    {"deletion", "timestamp:time type:whole id:text"},
    {"SceneUpdate", "deletions:deletion* entities:entity*"},
    {"Log", "timestamp:time level:whole message:text name:text file:text line:whole"},
    {"LocationFix", "timestamp:time frame_id:text latitude:number longitude:number altitude:number "
                    "position_covariance:number* position_covariance_type:whole"},
};

const QMap<QString, QJsonObject> scalars{
    {"number", {{"type", "number"}}},
    {"whole", {{"type", "integer"}, {"minimum", 0}, {"maximum", 4294967295.0}}},
    {"text", {{"type", "string"}}},
    {"flag", {{"type", "boolean"}}},
    {"bytes", {{"type", "string"}, {"contentEncoding", "base64"}}},
};

} // namespace

QJsonObject foxgloveSchema(const QString &name) {
    if (scalars.contains(name))
        return scalars[name];
    QJsonObject properties;
    for (const QString &member : QString(shapes[name]).split(' ', Qt::SkipEmptyParts)) {
        const QString type = member.section(':', 1);
        const bool isList = type.endsWith('*');
        const QJsonObject one = foxgloveSchema(isList ? type.chopped(1) : type);
        properties[member.section(':', 0, 0)] = isList ? QJsonObject{{"type", "array"}, {"items", one}} : one;
    }
    return {{"type", "object"},
            {"properties", properties},
            {"required", QJsonArray::fromStringList(properties.keys())}};
}

} // namespace hermes::web

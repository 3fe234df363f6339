#pragma once

#include "gui/desktop/widgets/LineEditor.h"

#include <memory>

namespace hermes::desktop {

/// How much all editors of a form may show together: what is beyond is shown as text, or not at all.
struct EditorRoom {
    int rows = 100;    ///< of lists and objects
    int values = 6000; ///< in texts
};

/// Where an editor stands in its form.
struct EditorPlace {
    std::shared_ptr<EditorRoom> room;
    int depth = 0;
    bool isOptional = false; ///< its value may be absent
    LineEditor::Empty empty = LineEditor::Empty::Absent;
};

/// The editor that suits a schema: a tick, a choice, a line, rows of a list or an object, or a text where
/// nothing else does.
ValueEditor *makeEditor(const QJsonObject &schema, const EditorPlace &place);

} // namespace hermes::desktop

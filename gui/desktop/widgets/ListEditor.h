#pragma once

#include "gui/desktop/widgets/EditorFactory.h"

#include <vector>

class QBoxLayout;
class QPushButton;
class QToolButton;

namespace hermes::desktop {

/// A list as rows, each with an editor of its element, to be added, removed and moved up and down. Elements
/// that are lists or objects are one line each, and fold out.
class ListEditor : public ValueEditor {
    Q_OBJECT
public:
    static constexpr int maxRows = 100;

    ListEditor(const QJsonObject &schema, const EditorPlace &place, QWidget *parent = nullptr);
    ~ListEditor() override;

    QJsonValue value() const override;
    void setValue(const QJsonValue &value) override;
    void addFaults(const QString &path, Faults &faults) const override;
    void showFaults(const QString &path, const Faults &faults) override;
    bool placeNote(QWidget *note) override;
    QWidgetList focusOrder() const override;

private:
    struct Row {
        QWidget *box;
        QPushButton *fold = nullptr;   // of an element that folds out
        ValueEditor *editor = nullptr; // none: it is folded up
        QJsonValue folded;
        QToolButton *up, *down, *remove;
    };

    Row &addRow(const QJsonValue &value);
    void setRow(Row &row, const QJsonValue &value);
    void makeRowEditor(Row &row, const QJsonValue &value);
    void unfold(Row &row, bool isUnfolded);
    void showFolded(Row &row);
    void move(const Row *row, int by);
    void remove(const Row *row);
    void add();
    void number();
    int indexOf(const Row *row) const;
    static QJsonValue valueOf(const Row &row) { return row.editor ? row.editor->value() : row.folded; }

    const QJsonObject schema_, item_;
    const EditorPlace place_;
    const bool foldsOut_;
    bool isGiven_ = false; // also when it has no rows
    std::vector<std::unique_ptr<Row>> rows_;
    QPushButton *add_;
    QBoxLayout *lines_, *foot_;
};

} // namespace hermes::desktop

#include "common/host/long_dialog.h"

#include <gtest/gtest.h>

#include <QApplication>
#include <QComboBox>
#include <QDockWidget>
#include <QGridLayout>
#include <QLabel>
#include <QPushButton>
#include <QScreen>
#include <QScrollArea>
#include <QScrollBar>
#include <QWheelEvent>

namespace meshcomplete {
namespace host {
namespace {

/// A dialog made like MeshLab's, with so many lists as parameters.
class Dialog {
 public:
  explicit Dialog(int parameters) {
    auto* content = new QFrame(&dock);
    dock.setWidget(content);
    dock.setFloating(true);
    dock.setWindowTitle("Some Filter");
    auto* grid = new QGridLayout(content);
    grid->addWidget(new QLabel("Description", content), 0, 0, 1, 2);
    auto* frame = new QFrame(content);
    auto* rows = new QGridLayout(frame);
    for (int row = 0; row < parameters; ++row) {
      lists.push_back(new QComboBox(frame));
      lists.back()->addItems({"one", "two", "three"});
      lists.back()->setCurrentIndex(1);
      rows->addWidget(lists.back(), row, 1);
    }
    grid->addWidget(frame, 1, 0, 1, 2);
    grid->addWidget(apply = new QPushButton("Apply", content), 2, 1);
    dock.setMinimumSize(content->sizeHint());
    dock.show();
    dock.adjustSize();
  }
  QScrollArea* area() { return dock.findChild<QScrollArea*>(); }
  int bottom() { return apply->mapToGlobal(QPoint(0, apply->height())).y(); }

  QDockWidget dock;
  std::vector<QComboBox*> lists;
  QPushButton* apply = nullptr;
};

int screen_bottom() { return QApplication::primaryScreen()->availableGeometry().bottom(); }

TEST(LongDialog, TheButtonsOfALongDialogAreOnTheScreen) {
  Dialog dialog(100);
  ASSERT_GT(dialog.bottom(), screen_bottom());
  fit_dialog_to_screen("Another Filter");
  QApplication::processEvents();
  EXPECT_EQ(dialog.area(), nullptr);
  fit_dialog_to_screen("Some Filter");
  QApplication::processEvents();
  ASSERT_NE(dialog.area(), nullptr);
  EXPECT_LE(dialog.bottom(), screen_bottom());
  EXPECT_GT(dialog.area()->verticalScrollBar()->maximum(), 0);
  EXPECT_GE(dialog.area()->viewport()->width(), dialog.lists[0]->width());
  fit_dialog_to_screen("Some Filter");
  QApplication::processEvents();
  EXPECT_EQ(dialog.dock.findChildren<QScrollArea*>().size(), 1) << "once is enough";
}

TEST(LongDialog, AShortDialogStaysAsItIs) {
  Dialog dialog(3);
  const QRect before = dialog.dock.geometry();
  fit_to_screen(dialog.dock);
  EXPECT_EQ(dialog.area(), nullptr);
  EXPECT_EQ(dialog.dock.geometry(), before);
}

TEST(LongDialog, OtherDialogsStayAsTheyAre) {
  QDockWidget empty, plain;
  fit_to_screen(empty);
  plain.setWidget(new QLabel("text"));
  fit_to_screen(plain);
  EXPECT_EQ(plain.findChild<QScrollArea*>(), nullptr);
}

TEST(LongDialog, TheWheelScrollsAndChangesNothing) {
  Dialog dialog(100);
  fit_to_screen(dialog.dock);
  QApplication::processEvents();
  QComboBox* list = dialog.lists[2];
  const QPointF middle = list->rect().center();
  ASSERT_GT(dialog.area()->verticalScrollBar()->maximum(), 0);
  QWheelEvent event(middle, list->mapToGlobal(middle.toPoint()), QPoint(), QPoint(0, -120), Qt::NoButton,
                    Qt::NoModifier, Qt::NoScrollPhase, false);
  QApplication::sendEvent(list, &event);
  EXPECT_EQ(list->currentIndex(), 1);
  EXPECT_GT(dialog.area()->verticalScrollBar()->value(), 0);
  dialog.area()->verticalScrollBar()->setValue(dialog.area()->verticalScrollBar()->maximum());
  QApplication::sendEvent(list, &event);
  EXPECT_EQ(list->currentIndex(), 1) << "nor where there is nothing left to scroll";
}

}  // namespace
}  // namespace host
}  // namespace meshcomplete

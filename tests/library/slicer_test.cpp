// What is sent to 3D Slicer, as the protocol's own library reads it.
#include "library/palpate/slicer.h"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <igtlClientSocket.h>
#include <igtlPointMessage.h>
#include <igtlPolyDataMessage.h>
#include <igtlStatusMessage.h>
#include <igtlTransformMessage.h>

namespace palpate::test {
namespace {

class SlicerTest : public testing::Test {
 protected:
  SlicerTest() {
    EXPECT_EQ(client_->ConnectToServer("127.0.0.1", slicer_.port()), 0);
    EXPECT_EQ(slicer_.clients(), 1);
  }

  /// The next message, whose checksum is right.
  template <class Message>
  typename Message::Pointer receive(const std::string& type, const std::string& name) {
    const igtl::MessageHeader::Pointer header = igtl::MessageHeader::New();
    header->InitPack();
    EXPECT_EQ(client_->Receive(header->GetPackPointer(), header->GetPackSize()), header->GetPackSize());
    header->Unpack();
    EXPECT_EQ(header->GetDeviceType(), type);
    EXPECT_EQ(header->GetDeviceName(), name);
    const typename Message::Pointer message = Message::New();
    message->SetMessageHeader(header);
    message->AllocatePack();
    EXPECT_EQ(client_->Receive(message->GetPackBodyPointer(), message->GetPackBodySize()),
              message->GetPackBodySize());
    EXPECT_TRUE((message->Unpack(1) & igtl::MessageHeader::UNPACK_BODY) != 0) << "the checksum is wrong";
    return message;
  }

  api::Slicer slicer_{{.port = 0, .scale = 1000.0}};
  igtl::ClientSocket::Pointer client_ = igtl::ClientSocket::New();
};

TEST_F(SlicerTest, APlaceIsATransformInMillimetres) {
  slicer_.send_place("hand", {0.25, -0.5, 2.0});
  const auto message = receive<igtl::TransformMessage>("TRANSFORM", "hand");
  igtl::Matrix4x4 matrix;
  message->GetMatrix(matrix);
  const float expected[4][4] = {{1, 0, 0, 250}, {0, 1, 0, -500}, {0, 0, 1, 2000}, {0, 0, 0, 1}};
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) EXPECT_EQ(matrix[row][column], expected[row][column]);
  }
}

TEST_F(SlicerTest, MarksHaveNamesPlacesAndColours) {
  slicer_.send_marks("marks", {{.name = "apex", .position = {0.001, 0.002, 0.003}, .color = {1, 2, 3, 4}},
                               {.name = std::string(63, 'b'), .position = {-1, 0, 0}}});
  const auto message = receive<igtl::PointMessage>("POINT", "marks");
  ASSERT_EQ(message->GetNumberOfPointElement(), 2);
  igtl::PointElement::Pointer mark;
  message->GetPointElement(0, mark);
  EXPECT_STREQ(mark->GetName(), "apex");
  igtlUint8 color[4];
  mark->GetRGBA(color);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(color[i], i + 1);
  igtlFloat32 x[3];
  mark->GetPosition(x);
  for (int i = 0; i < 3; ++i) EXPECT_FLOAT_EQ(x[i], static_cast<float>(i + 1));
  message->GetPointElement(1, mark);
  EXPECT_EQ(mark->GetName(), std::string(63, 'b'));
}

TEST_F(SlicerTest, LinesHaveTheirPointsAndErrors) {
  const api::Field field = api::Field::example("abc");
  const api::Lines lines = api::trace(field, field.seeds("random:3"), {.max_length = 3.0});
  slicer_.send_lines("lines", lines);
  const auto message = receive<igtl::PolyDataMessage>("POLYDATA", "lines");
  ASSERT_EQ(message->GetPoints()->GetNumberOfPoints(), static_cast<int>(lines.points().size()));
  for (std::size_t i = 0; i < lines.points().size(); ++i) {
    igtlFloat32 x[3];
    message->GetPoints()->GetPoint(static_cast<unsigned>(i), x);
    for (std::size_t axis = 0; axis < 3; ++axis)
      ASSERT_EQ(x[axis], static_cast<float>(1000.0 * lines.points()[i][axis]));
  }
  ASSERT_EQ(message->GetLines()->GetNumberOfCells(), lines.count());
  for (std::size_t l = 0; l < lines.count(); ++l) {
    std::list<igtlUint32> cell;
    message->GetLines()->GetCell(static_cast<unsigned>(l), cell);
    ASSERT_EQ(cell.size(), static_cast<std::size_t>(lines.offsets()[l + 1] - lines.offsets()[l]));
    EXPECT_EQ(cell.front(), lines.offsets()[l]);
    EXPECT_EQ(cell.back() + 1, lines.offsets()[l + 1]);
  }
  ASSERT_EQ(message->GetNumberOfAttributes(), 1);
  igtl::PolyDataAttribute* const error = message->GetAttribute(0);
  EXPECT_STREQ(error->GetName(), "error");
  EXPECT_EQ(error->GetType(), igtl::PolyDataAttribute::POINT_SCALAR);
  EXPECT_EQ(error->GetNumberOfComponents(), 1U);
  ASSERT_EQ(error->GetSize(), lines.points().size());
  for (std::size_t i = 0; i < lines.error().size(); ++i) {
    igtlFloat32 value = 0;
    error->GetNthData(static_cast<unsigned>(i), &value);
    ASSERT_EQ(value, static_cast<float>(lines.error()[i]));
  }
}

TEST_F(SlicerTest, TouchIsTwoPlacesAndTheForceBetween) {
  slicer_.send_touch("",
                     {.present = true, .probe = {0.01, 0, 0}, .proxy = {0.002, 0, 0}, .force = {-1.5, 0, 0}});
  (void)receive<igtl::TransformMessage>("TRANSFORM", "Probe");
  (void)receive<igtl::TransformMessage>("TRANSFORM", "Proxy");
  const auto force = receive<igtl::PolyDataMessage>("POLYDATA", "Force");
  igtlFloat32 from[3], to[3];
  force->GetPoints()->GetPoint(0, from);
  force->GetPoints()->GetPoint(1, to);
  EXPECT_FLOAT_EQ(from[0], 2.0F);
  EXPECT_FLOAT_EQ(to[0], 2.0F - 15.0F);  // ten millimetres a newton
  EXPECT_EQ(force->GetNumberOfAttributes(), 0);
}

TEST_F(SlicerTest, StatusHasItsWords) {
  slicer_.send_status("servo", igtl::StatusMessage::STATUS_OK, "1000 steps");
  const auto message = receive<igtl::StatusMessage>("STATUS", "servo");
  EXPECT_EQ(message->GetCode(), igtl::StatusMessage::STATUS_OK);
  EXPECT_STREQ(message->GetStatusString(), "1000 steps");
}

TEST_F(SlicerTest, WhoLeavesIsLetGoAndLongNamesAreRefused) {
  EXPECT_THROW(slicer_.send_place("a name of 21 letters.", {}), api::Error);
  EXPECT_THROW(slicer_.send_marks("marks", {{.name = std::string(64, 'b')}}), api::Error);
  EXPECT_THROW(api::Slicer({.port = slicer_.port()}), api::Error);
  client_->CloseSocket();
  for (int i = 0; i < 1000 && slicer_.clients() > 0; ++i) slicer_.send_place("hand", {});
  EXPECT_EQ(slicer_.clients(), 0);
}

}  // namespace
}  // namespace palpate::test

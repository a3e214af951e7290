#include "tools/base/pose_table.h"

#include <gmock/gmock.h>

#include <sstream>

namespace base {
namespace {

using testing::AnyOf;
using testing::ElementsAre;
using testing::HasSubstr;

// Words of the last line in order, the stamp in seconds; or the problem.
std::vector<std::string> LastOf(const std::string& text, bool is_euroc = false) {
  PoseTable table(is_euroc);
  std::vector<std::string> last;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    last.clear();
    std::string problem;
    const std::vector<Word> row = table.Row(line, problem);
    if (!problem.empty()) return {problem};
    for (const Word& word : row) last.push_back(last.empty() ? table.Stamp(word) : std::string(word.text));
  }
  return last;
}

// The same pose under headers of different column orders.
TEST(PoseTable, TakesTheOrderOfItsHeader) {
  for (const std::string text :
       {"# timestamp tx ty tz qx qy qz qw\n7.5 1 2 3 4 5 6 9",
        "% timestamp tx ty tz qw qx qy qz\n7.5 1 2 3 9 4 5 6",
        "// made by x: position, time t\n# t x y z qw qx qy qz\n7.5 1 2 3 9 4 5 6",
        "\"timestamp\",\"frame\",\"rot_x\",\"rot_y\",\"rot_z\",\"rot_w\",\"pos_x\",\"pos_y\",\"pos_z\"\n"
        "7.5,11,4,5,6,9,1,2,3",
        "Time,header.stamp.secs,header.frame_id,pose.position.x,pose.position.y,pose.position.z,pose.orientation.x,"
        "pose.orientation.y,pose.orientation.z,pose.orientation.w,twist.linear.x\n7.5,6,map,1,2,3,4,5,6,9,8",
        "time; px [m]; py [m]; pz [m]; qx; qy; qz; qw; vx\n7.5;1;2;3;4;5;6;9;8\x1a",
        "# timestamp(s) tx ty tz qx qy qz qw Pr11\n7.5 1 2 3 4 5 6 9 0 0 0 0 0 0 0 0 0 0 0 0",
        "# format: timestamp tx ty tz qw qx qy qz (w first)\n7.5 1 2 3 9 4 5 6",
        "# timestamp tx ty tz qx qy qz qw (x forward, z up)\n7.5 1 2 3 4 5 6 9",
        "Timestamp, Position X, Position Y, Position Z, Orientation W, Orientation X, Orientation Y, Orientation Z\n"
        "7.5, 1, 2, 3, 9, 4, 5, 6",
        "timestamp_sec,tx,ty,tz,qw,qx,qy,qz,label\n7.5,1,2,3,9,4,5,6,",
        "# seconds x_m y_m z_m qw qx qy qz\n7.5 1 2 3 9 4 5 6",
        "# stamp_secs location_x location_y location_z quat_w quat_x quat_y quat_z\n7.5 1 2 3 9 4 5 6",
        "t,x,y,z,ow,ox,oy,oz\n7.5,1,2,3,9,4,5,6",
        "# timestamp x y z w i j k\n7.5 1 2 3 9 4 5 6",
        "timestamp,speed_x,speed_y,speed_z,x,y,z,qx,qy,qz,qw\n7.5,8,8,8,1,2,3,4,5,6,9",
        "timestamp,x,y,z,orientation_yaw,orientation_w,orientation_x,orientation_y,orientation_z\n7.5,1,2,3,8,9,4,5,6",
        "timestamp,tx,ty,tz,rw,rx,ry,rz\n7.5,1,2,3,9,4,5,6",
        "frame_time,cam_x,cam_y,cam_z,cam_qw,cam_qx,cam_qy,cam_qz\n7.5,1,2,3,9,4,5,6",
        "time x y z qr qi qj qk\n7.5 1 2 3 9 4 5 6",
        "# timestamp [s], position x [m], position y [m], position z [m], attitude w, attitude x, attitude y, attitude "
        "z\n7.5, 1, 2, 3, 9, 4, 5, 6",
        "t,T_W_B.x,T_W_B.y,T_W_B.z,R_W_B.w,R_W_B.x,R_W_B.y,R_W_B.z\n7.5,1,2,3,9,4,5,6",
        "# timestamp position(x y z) quaternion(w x y z)\n7.5 1 2 3 9 4 5 6",
        "# timestamp, position (x, y, z), orientation quaternion (w, x, y, z)\n7.5, 1, 2, 3, 9, 4, 5, 6",
        "timestamp,vel_x,vel_y,vel_z,base_x,base_y,base_z,qs,qx,qy,qz\n7.5,8,8,8,1,2,3,9,4,5,6",
        "__time,/vo/orientation/w,/vo/orientation/x,/vo/orientation/y,/vo/orientation/z,/vo/position/x,/vo/position/y,"
        "/vo/position/z\n7.5,9,4,5,6,1,2,3",
        ",timestamp,tx,ty,tz,qw,qx,qy,qz\n0,7.5,1,2,3,9,4,5,6",
        "\"t\",\"x\",\"y\",\"z\",\"qx\",\"qy\",\"qz\",\"qw\"\n\"7.5\",\"1\",\"2\",\"3\",\"4\",\"5\",\"6\",\"9\""}) {
    EXPECT_THAT(LastOf(text), ElementsAre("7.5", "1", "2", "3", "4", "5", "6", "9")) << text;
  }
}

TEST(PoseTable, JoinsSecondsAndTheirParts) {
  for (const std::string header : {"#counter, sec, nsec,x,y,z,qx,qy,qz,qw", "field.seq,secs,nsecs,x,y,z,qx,qy,qz,qw",
                                   "seq,header.stamp.sec,header.stamp.nanosec,tx,ty,tz,qx,qy,qz,qw"}) {
    EXPECT_EQ(LastOf(header + "\n8,1583836591,82590976,1,2,3,4,5,6,9").at(0), "1583836591.082590976") << header;
    EXPECT_EQ(LastOf(header + "\n8,7,0,1,2,3,4,5,6,9\n8,7,500000000,1,2,3,4,5,6,9").at(0), "7.500000000");
  }
  const std::string of_ros =
      "Time,header.stamp.secs,header.stamp.nsecs,x,y,z,qx,qy,qz,qw\n7.6,7,500000000,1,2,3,4,5,6,9";
  EXPECT_EQ(LastOf(of_ros).at(0), "7.500000000") << "not the time of arrival";
  EXPECT_THAT(LastOf("x,y,z,qx,qy,qz,qw,sec,nsec\n1,2,3,4,5,6,9,7,5\n1,2,3,4,5,6,9,8"),
              ElementsAre(HasSubstr("names 9 columns, and this row has 8")));
  EXPECT_EQ(LastOf("# counter sec nsec x y z qx qy qz qw\n8 7 40 1 2 3 4 5 6 9").at(0), "7.000000040");
  EXPECT_EQ(LastOf("sec,usec,x,y,z,qx,qy,qz,qw\n7,40,1,2,3,4,5,6,9").at(0), "7.000040");
  EXPECT_EQ(LastOf("x,y,z,qx,qy,qz,qw,stamp_secs,stamp_msecs\n1,2,3,4,5,6,9,7,40").at(0), "7.040");
  EXPECT_EQ(LastOf("time_usec,x,y,z,qx,qy,qz,qw\n40,1,2,3,4,5,6,9").at(0), "40e-6") << "no seconds beside them";
}

// Integer stamps of EuRoC's, VINS' and ROS' tables are nanoseconds; ROS: the header's stamp, not the time of arrival.
TEST(PoseTable, NanosecondsWhereTheTableHasThem) {
  for (const std::string text :
       {"#timestamp [ns],x,y,z,qw,qx,qy,qz\n75,1,2,3,9,4,5,6,",
        "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z []\n"
        "75,1,2,3,9,4,5,6,0,0,0",
        "%time,field.header.seq,field.header.stamp,field.header.frame_id,field.pose.position.x,field.pose.position.y,"
        "field.pose.position.z,field.pose.orientation.x,field.pose.orientation.y,field.pose.orientation.z,"
        "field.pose.orientation.w\n80,1,75,map,1,2,3,4,5,6,9",
        "%time,field.header.stamp,field.child_frame_id,field.transform.translation.x,field.transform.translation.y,"
        "field.transform.translation.z,field.transform.rotation.x,field.transform.rotation.y,field.transform.rotation."
        "z,"
        "field.transform.rotation.w\n80,75,,1,2,3,4,5,6,9",
        "#timestamp [nsec],tx,ty,tz,qx,qy,qz,qw\n75,1,2,3,4,5,6,9",
        "time_nanoseconds tx ty tz qx qy qz qw\n75 1 2 3 4 5 6 9",
        "timestamp_ns tx ty tz qx qy qz qw\n75 1 2 3 4 5 6 9", "75,1,2,3,9,4,5,6,0,0,0,0,0,0,0,0,0"}) {
    EXPECT_THAT(LastOf(text), ElementsAre("75e-9", "1", "2", "3", "4", "5", "6", "9")) << text;
  }
  EXPECT_EQ(LastOf("#t [ns],x,y,z,qw,qx,qy,qz\n1.5e+18,1,2,3,9,4,5,6").at(0), "1.5e9");
  EXPECT_EQ(LastOf("#t [ns] x y z qx qy qz qw\n1403636580838555648.000000 1 2 3 4 5 6 9").at(0),
            "1403636580838555648.000000e-9");
  EXPECT_EQ(LastOf("#t [ms],x,y,z,qw,qx,qy,qz\n12.5,1,2,3,9,4,5,6").at(0), "12.5e-3");
  for (const std::string unit : {"time (milliseconds)", "t [msec]", "t_millisecs"})
    EXPECT_EQ(LastOf(unit + ",x,y,z,qx,qy,qz,qw\n12.5,1,2,3,4,5,6,9").at(0), "12.5e-3") << unit;
  for (const std::string unit : {"#t [\xc2\xb5s]", "t (\xce\xbcs)", "t [usec]", "t_microseconds"})
    EXPECT_EQ(LastOf(unit + ",x,y,z,qx,qy,qz,qw\n12.5,1,2,3,4,5,6,9").at(0), "12.5e-6") << unit;
  EXPECT_EQ(LastOf("#t [ns],x,y,z,qw,qx,qy,qz\n12.5,1,2,3,9,4,5,6").at(0), "12.5") << "seconds, the header kept";
  EXPECT_EQ(LastOf("%time x y z qx qy qz qw\n75 1 2 3 4 5 6 9").at(0), "75") << "a comment of MATLAB's";
  EXPECT_THAT(LastOf("75 1 2 3 9 4 5 6", true), ElementsAre("75e-9", "1", "2", "3", "4", "5", "6", "9"));
}

TEST(PoseTable, RefusesUnitsAndOrdersThatItDoesNotTake) {
  const std::string row = "\n7,1,2,3,4,5,6,9";
  for (const std::string header : {"t,x(mm),y(mm),z(mm),qx,qy,qz,qw", "# t, tx [MM], ty [MM], tz [MM], qx, qy, qz, qw"})
    EXPECT_THAT(LastOf(header + row), ElementsAre(HasSubstr("positions in mm"))) << header;
  for (const std::string header :
       {"timestamp,x,y,z,q[0],q[1],q[2],q[3]", "# t x y z q1 q2 q3 q4", "time,x,y,z,a,b,c,d", "# ts, xyz, wxyz",
        "# format: time position quaternion(wxyz)", "# quaternion is scalar first\n# timestamp tx ty tz quat"})
    EXPECT_THAT(LastOf(header + row), ElementsAre(AnyOf(HasSubstr("names no column"), HasSubstr("w comes first"))))
        << header;
  EXPECT_EQ(LastOf("# quaternion: qw qx qy qz\n# timestamp tx ty tz qw qx qy qz\n7 1 2 3 9 4 5 6").at(7), "9");
  EXPECT_THAT(LastOf("7 1 0 0 1 0 1 0 2 0 0 1 3 0 0 0 1"), ElementsAre(HasSubstr("matrices")));
}

TEST(PoseTable, RefusesOtherKindsByTheFirstRow) {
  for (const auto& [text, words] : std::vector<std::pair<std::string, std::string>>{
           {"1 0 0 0 0 1 0 0 0 0 1 0", "KITTI"},
           {"1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1", "matrices"},
           {"1403636579763555584,1,2,3,1,0,0,0,0.1,0.2,0.3,",
            "nanoseconds: divide the times by 1e9; where qw comes first"},
           {"1403636579763 1 2 3 1 0 0 0", "milliseconds: divide the times by 1e3"},
           {"0,5;1,5;2,5;3,5;0,5;0,5;0,5;0,5", "decimal commas"},
           {"VERTEX_SE3:QUAT 0 1 2 3 0 0 0 1", "g2o"},
           {"# IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME\n1 1 0 0 0 1 2 3 1 a.png", "COLMAP"},
           {"2014-06-24T19:03:00 1 2 3 0 0 0 1", "is not a time in seconds"},
           {"1403636579763555584,1,2,3", "4 columns where 8 are expected"},
           {"1.5,1,2,3,0,0,0,1,0,0,0,0,0,0,0,0,0", "17 columns"},
           {"1.5 1 2 3 0 0 0 1 0 0 0 a", "12 columns"},
           {"1 0.1 0.2 0.3 0.4 1 2 3 1 rgb/a.png", "COLMAP"},
           {"Format Version,1.23,Take Name,Take 2024,Rotation Type,Quaternion,Length Units,Millimeters,Rate,120,x",
            "Motive"},
           {"Format Version,Take Name,Take,Notes,Rotation Type,Quaternion,Length Units,Millimeters", "Motive"},
           {"{", "is JSON"},
           {"#ROSBAG V2.0", "is a ROS bag"},
           {"# timestamp [s] position x y z [m] quaternion w x y z\n1 1 2 3 1 0 0 0", "no column for qx, qy, qz"},
           {"# id tx ty tz qw qx qy qz\n1 1 2 3 1 0 0 0", "no column for timestamp"},
           {"t,x,y,z,q0,q1,q2,q3\n1,1,2,3,1,0,0,0", "no column for qx, qy, qz, qw"},
           {"t,x,y,z,quaternion,wxyz,a,b\n1,1,2,3,1,0,0,0", "no column for qx, qy, qz, qw"},
           {"t,a,b,c,qw,qx,qy,qz\n1,1,2,3,1,0,0,0", "no column for tx, ty, tz"},
           {"t,gt_px,gt_py,gt_pz,gt_qx,gt_qy,gt_qz,gt_qw,px,py,pz,qx,qy,qz,qw\n1,1,2,3,0,0,0,1,1,2,3,0,0,0,1",
            "two poses"},
           {"t,x,y,z,v,qw,qx,qy,qz\n1,1,2,3,1,0,0,0", "the header names 9 columns, and this row has 8"}}) {
    const std::vector<std::string> said = LastOf(text);
    ASSERT_EQ(said.size(), 1u) << text;
    EXPECT_THAT(said[0], HasSubstr(words));
  }
  EXPECT_EQ(LastOf("1 1 2 3 0 0 0 1\n2 1 2 3").size(), 4u) << "a later row comes as it is";
}

TEST(PoseTable, RowsAndHeadersThatWouldBeTakenForOthers) {
  EXPECT_THAT(LastOf("+7 +1 +2 +3 +4 +5 +6 +9"), ElementsAre("+7", "+1", "+2", "+3", "+4", "+5", "+6", "+9"));
  EXPECT_THAT(LastOf("id,t,cov,x,y,z,qx,qy,qz,qw\n0,7,\"(1, 2, 3)\",1,2,3,4,5,6,9"),
              ElementsAre("7", "1", "2", "3", "4", "5", "6", "9"));
  for (const auto& [text, words] : std::vector<std::pair<std::string, std::string>>{
           {"id,t,cov,x,y,z,qx,qy,qz,qw\n0,7,(1,2,3),1,2,3,4,5,6,9", "names 10 columns, and this row has 12"},
           {"stamp,p1,p2,p3,q1,q2,q3,q4\n7,1,2,3,1,0,0,0", "names no columns of a pose"},
           {"a b c d e f g h\n7 1 2 3 1 0 0 0", "names no columns of a pose"},
           {"# Zeit, x, y, z, q1, q2, q3, q4\n7,1,2,3,1,0,0,0", "no column for timestamp, qx, qy, qz, qw"},
           {"Frame,Sub Frame,RX,RY,RZ,TX,TY,TZ\n1,0,0.1,0.2,0.3,0,0,0", "the header names no column"},
           {"# T_CW, world to camera\n# timestamp tx ty tz qx qy qz qw\n7 1 2 3 0 0 0 1", "invert them"},
           {"0 1 2 3 0 0 0 1\n50000000 1 2 3 0 0 0 1", "more than 1000 s after the first"}})
    EXPECT_THAT(LastOf(text), ElementsAre(HasSubstr(words))) << text;
  for (const char* comment :
       {"# This file holds the poses of the left camera in world frame", "// one two three four five six seven eight",
        "# camera to world (inverse of world-to-camera)"})
    EXPECT_THAT(LastOf(std::string(comment) + "\n7 1 2 3 4 5 6 9"),
                ElementsAre("7", "1", "2", "3", "4", "5", "6", "9"));
  EXPECT_THAT(LastOf("# format: id timestamp tx ty tz qx qy qz qw\n0 7 1 2 3 4 5 6 9"),
              ElementsAre("7", "1", "2", "3", "4", "5", "6", "9"));
  EXPECT_THAT(LastOf("0 1.0 0.0 0.0 0.5 0.0 1.0 0.0 0.5 0.0 0.0 1.0 0.5 0.0 0.0 0.000 1.0"),
              ElementsAre(HasSubstr("seventeen numbers a line are times and matrices")));
  EXPECT_EQ(LastOf("# timestamp_ns tx ty tz qx qy qz qw\n0 1 2 3 0 0 0 1\n50000000 1 2 3 0 0 0 1").at(0),
            "50000000e-9");
}

}  // namespace
}  // namespace base

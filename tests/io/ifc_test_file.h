// A small IFC file: one box, 10 x 5 x 3 units, from (1, 2, 0) to (11, 7, 3).
#pragma once

#include <string>

namespace gnomon {

struct IfcTestFile {
  std::string schema = "IFC2X3";
  std::string unit = "#20=IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.);";
  std::string world = "#31=IFCAXIS2PLACEMENT3D(#50,$,$);";
  std::string north = "$";  // "#32": 30 degrees clockwise from +y
  std::string latitude = "$", longitude = "$", elevation = "$";
  std::string more = {};
  std::string body = "#76=IFCEXTRUDEDAREASOLID(#72,#75,#73,3.);";
  std::string placement = "#52=IFCLOCALPLACEMENT($,#51);";

  std::string text() const {
    return "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\n"
           "FILE_NAME('box.ifc','2024-01-01T00:00:00',(''),(''),'','','');\nFILE_SCHEMA(('" +
           schema +
           "'));\nENDSEC;\nDATA;\n"
           "#1=IFCORGANIZATION($,'X',$,$,$);\n"
           "#2=IFCAPPLICATION(#1,'1','X','X');\n"
           "#3=IFCPERSON($,'X',$,$,$,$,$,$);\n"
           "#4=IFCPERSONANDORGANIZATION(#3,#1,$);\n"
           "#5=IFCOWNERHISTORY(#4,#2,$,.ADDED.,$,$,$,0);\n" +
           unit +
           "\n#21=IFCSIUNIT(*,.PLANEANGLEUNIT.,$,.RADIAN.);\n"
           "#22=IFCUNITASSIGNMENT((#21,#20));\n" +
           world +
           "\n#32=IFCDIRECTION((0.5,0.8660254037844386));\n"
           "#33=IFCGEOMETRICREPRESENTATIONCONTEXT($,'Model',3,1.E-5,#31," +
           north +
           ");\n#34=IFCGEOMETRICREPRESENTATIONCONTEXT($,'Plan',2,1.E-5,#31,$);\n"
           "#40=IFCPROJECT('0000000000000000000001',#5,'P',$,$,$,$,(#34,#33),#22);\n"
           "#50=IFCCARTESIANPOINT((0.,0.,0.));\n"
           "#51=IFCAXIS2PLACEMENT3D(#50,$,$);\n" +
           placement + "\n#60=IFCSITE('0000000000000000000002',#5,'Site',$,$,#52,$,$,.ELEMENT.," +
           latitude + "," + longitude + "," + elevation +
           ",$,$);\n"
           "#61=IFCBUILDING('0000000000000000000003',#5,'B',$,$,#52,$,$,.ELEMENT.,$,$,$);\n"
           "#62=IFCBUILDINGSTOREY('0000000000000000000004',#5,'S',$,$,#52,$,$,.ELEMENT.,0.);\n"
           "#63=IFCRELAGGREGATES('0000000000000000000005',#5,$,$,#40,(#60));\n"
           "#64=IFCRELAGGREGATES('0000000000000000000006',#5,$,$,#60,(#61));\n"
           "#65=IFCRELAGGREGATES('0000000000000000000007',#5,$,$,#61,(#62));\n"
           "#70=IFCCARTESIANPOINT((5.,2.5));\n"
           "#71=IFCAXIS2PLACEMENT2D(#70,$);\n"
           "#72=IFCRECTANGLEPROFILEDEF(.AREA.,$,#71,10.,5.);\n"
           "#73=IFCDIRECTION((0.,0.,1.));\n"
           "#74=IFCCARTESIANPOINT((1.,2.,0.));\n"
           "#75=IFCAXIS2PLACEMENT3D(#74,$,$);\n" +
           body +
           "\n#77=IFCSHAPEREPRESENTATION(#33,'Body','SweptSolid',(#76));\n"
           "#78=IFCPRODUCTDEFINITIONSHAPE($,$,(#77));\n"
           "#79=IFCBUILDINGELEMENTPROXY('0000000000000000000008',#5,'Box',$,$,#52,#78,$,$);\n"
           "#80=IFCRELCONTAINEDINSPATIALSTRUCTURE('0000000000000000000009',#5,$,$,(#79),#62);\n" +
           more + "ENDSEC;\nEND-ISO-10303-21;\n";
  }
};

// Length units, as entity #20.
inline const std::string kIfcMillimetres = "#20=IFCSIUNIT(*,.LENGTHUNIT.,.MILLI.,.METRE.);";
inline const std::string kIfcFeet =
    "#17=IFCDIMENSIONALEXPONENTS(1,0,0,0,0,0,0);\n"
    "#18=IFCMEASUREWITHUNIT(IFCLENGTHMEASURE(304.8),#19);\n"
    "#19=IFCSIUNIT(*,.LENGTHUNIT.,.MILLI.,.METRE.);\n"
    "#20=IFCCONVERSIONBASEDUNIT(#17,.LENGTHUNIT.,'FOOT',#18);";

}  // namespace gnomon

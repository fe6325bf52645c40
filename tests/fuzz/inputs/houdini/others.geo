["fileversion","13.0","hasindex",false,"pointcount",5,"vertexcount",11,"primitivecount",3,
"info",{"bounds":[0,1,0,1,0,1],"time":1e-3},"topology",["pointref",["indices",[0,1,2,3,2,1,0,4,1,3,4]]],
"attributes",["pointattributes",[[["scope","public","type","numeric","name","P","options",{"type":{"type":"string","value":"hpoint"}}],
["size",4,"storage","fpreal32","defaults",["size",4,"storage","fpreal64","values",[0,0,0,1]],"values",["size",4,"storage","fpreal32",
"pagesize",2,"packing",[3,1],"constantpageflags",[[false,true,false],[true,true,true]],"rawpagedata",[0,0,0,1,0,0,1,0,1,0,1,0,0,1,1]]]]]],
"primitives",[[["type","run","runtype","Poly","varyingfields",["vertex"],"uniformfields",{"closed":true}],[[[0,1,2,3]]]],
[["type","Poly"],["vertex",[6,5,4],"closed",true]],[["type","Tetrahedron"],["vertex",[7,8,9,10]]]],
"pointgroups",[[["name","g","type","point"],["selection",["defaults",["size",1,"storage","int64","values",[0]],"unordered",["i8",[0,1,0,1,1]]]]]]]
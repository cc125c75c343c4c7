# cmake -Dname= -Dptx= -Dmade= -P: the text of a file as a constant of C++.
set(text "")
if(EXISTS ${ptx})
  file(READ ${ptx} text)
endif()
file(WRITE ${made} "namespace tress::models {
extern const char* const ${name};
const char* const ${name} = R\"ptx(${text})ptx\";
}  // namespace tress::models
")

# Installs the program, the library with its headers, the Python module and the assets, which both find relative to where
# they are.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS patina RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
# The library goes to lib, not to Debian's lib/<triplet>, so that a prefix can be moved as a whole.
install(TARGETS libpatina EXPORT patina-targets LIBRARY DESTINATION lib)
install(DIRECTORY ${patina_SOURCE_DIR}/include/patina DESTINATION include FILES_MATCHING PATTERN "*.h")
install(DIRECTORY ${patina_SOURCE_DIR}/assets DESTINATION share/patina PATTERN "README.md" EXCLUDE)
install(FILES ${patina_SOURCE_DIR}/LICENSE DESTINATION share/doc/patina)
install(EXPORT patina-targets NAMESPACE patina:: DESTINATION lib/cmake/patina)
write_basic_package_version_file(${patina_BINARY_DIR}/patina-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_LIST_DIR}/patina-config.cmake ${patina_BINARY_DIR}/patina-config-version.cmake
        DESTINATION lib/cmake/patina)

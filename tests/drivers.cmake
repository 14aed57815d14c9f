# Runs test programs that need a Vulkan device once per driver. A process that starts under one of these environments sees
# exactly one driver, so that no test can end up on another.

set(PATINA_SWIFTSHADER_ICD "" CACHE FILEPATH "Manifest of SwiftShader's Vulkan driver; tools/fetch_swiftshader prints it")
option(PATINA_TEST_FULL "Runs tests that take minutes each, too: other builds, and whole reconstructions on every driver" OFF)
option(PATINA_TEST_HARDWARE "Runs the GPU tests on a discrete GPU too" OFF)

file(GLOB LAVAPIPE_ICD /usr/share/vulkan/icd.d/lvp_icd*.json)
if(NOT LAVAPIPE_ICD)
    message(FATAL_ERROR "lavapipe's manifest /usr/share/vulkan/icd.d/lvp_icd*.json is missing: install mesa-vulkan-drivers")
endif()

set(PATINA_DRIVERS lavapipe256 lavapipe128)
foreach(WIDTH 256 128)
    # Mesa's shader cache does not tell vector widths apart, so each has its own.
    set(PATINA_ENVIRONMENT_lavapipe${WIDTH}
        VK_DRIVER_FILES=${LAVAPIPE_ICD} VK_ICD_FILENAMES=${LAVAPIPE_ICD} PATINA_DEVICE=cpu
        LP_NATIVE_VECTOR_WIDTH=${WIDTH} MESA_SHADER_CACHE_DIR=${patina_BINARY_DIR}/mesa-${WIDTH}
        XDG_CACHE_HOME=${patina_BINARY_DIR}/cache-${WIDTH})
endforeach()
if(PATINA_SWIFTSHADER_ICD)
    list(APPEND PATINA_DRIVERS swiftshader)
    set(PATINA_ENVIRONMENT_swiftshader
        VK_DRIVER_FILES=${PATINA_SWIFTSHADER_ICD} VK_ICD_FILENAMES=${PATINA_SWIFTSHADER_ICD} PATINA_DEVICE=cpu
        XDG_CACHE_HOME=${patina_BINARY_DIR}/cache-swiftshader)
else()
    add_test(NAME gpu.swiftshader COMMAND ${CMAKE_COMMAND} -E echo "Skipped: PATINA_SWIFTSHADER_ICD is not set")
    set_tests_properties(gpu.swiftshader PROPERTIES SKIP_REGULAR_EXPRESSION "Skipped: ")
endif()
if(PATINA_TEST_HARDWARE)
    list(APPEND PATINA_DRIVERS hardware)
    set(PATINA_ENVIRONMENT_hardware PATINA_DEVICE=discrete)
endif()

# Suites and TESTs that reconstruct whole scenes. They take most of the time, and what differs between drivers shows in
# single passes and in the stored results (Golden), so that all but the first driver run them with PATINA_TEST_FULL alone.
set(PATINA_WHOLE_SUITES "^(DragLamp|GrowingPoolsTest|Localise|PipelineTest|ReconstructionApiTest|Relocalisation|SegmentationStageTest|SessionExtendTest|SessionMapTest|SessionTest|StreamingTest|SynthTest|TrackingTest|WarmUp|All/BuiltinScenesOnGpu)$")
set(PATINA_WHOLE_TESTS Golden.CubesBeyondFourMetresGiveTheStoredNumbers:Golden.RecordedAndLiveSceneGiveTheSameScene:Golden.SceneIsValidGltf:Golden.TwoRunsGiveTheSameBytes:Golden.TwoTrackedRunsGiveTheSameBytes:Golden.ValidationHasNothingToSayAndTheGraphIsDumped)

# TESTs that take 5 to 30 s, beside others of the same code: these run with PATINA_TEST_FULL alone.
set(PATINA_LONG_TESTS FindVisibilityTest.KdOfAGlossySceneWithShadowsIsFoundThroughTheWholePipeline:FindVisibilityTest.WhatLiesOutsideTheBallThrowsNoShadow:FindVisibilityTest.WithoutShadowsEveryLightReachesEveryRecord:FitWardTest.HighlightsOfBentSurfacesAreTakenForBlurred:FitWardTest.TheWholeSegmentsAlbedoIsThatOfItsVoxelsWithoutTheirHighlights:GatherIrradianceTest.RaysAddUpToASlidingMean:LightFitting.TheirIntensityFollowsFromWhiteAndTooLargeAMisfitMeansNone:MarkBlocks.RaysFindTheSameAsWhereEveryBlockIsLookedAt:PipelineTest.ObservationsOfThingsThatWentAreGivenBackInFramesThatAreHeldOutToo:RelightTest.EachTurnWithRaysIsABounce:SessionUndoTest.KeepingAModelChangesNothing:StreamingTest.CellsAreTogetherTheWholeSurface:StreamingTest.ViewsBetweenFramesMakeNoDifference)

# No shader uses subgroup operations, so that the width of vectors changes nothing but how the driver compiles a pass. Without
# PATINA_TEST_FULL the narrower lavapipe runs the TESTs that compare a pass with its CPU reference, but for the longest ones, and
# these folders as a whole.
set(PATINA_COMPARING_TESTS "*Reference*")  # by their names
set(PATINA_LAVAPIPE128_LONG_TESTS FindVisibilityTest.BitsAgreeWithTheReferenceOnEverySurface:IntegrateTest.OneFrameAndSeveralAgreeWithTheReference:RunNetwork.HalvesAgreeWithTheReferenceOnAwkwardShapes)
set(PATINA_LAVAPIPE128_WHOLE_FOLDERS "^(engine|input|photometry|surface|texture|viewer)$")

# SwiftShader is three times slower than lavapipe: without PATINA_TEST_FULL it runs the folders of which each pass is a
# kind of its own, and of the two longest of these what compares a pass with its CPU reference.
set(PATINA_SWIFTSHADER_FOLDERS "^(engine|input|kinect2|photometry|shading)$")
set(PATINA_SWIFTSHADER_WHOLE_FOLDERS "^(engine|input|photometry)$")
set(PATINA_SWIFTSHADER_LONG_TESTS ReflectSurroundings.ItsMeanIsThatOfTheReference)

# Registers the suites of a GoogleTest program, each as "PREFIX.Suite", with a label and what follows it as environment. Where
# there is one, the program needs a driver: to open a device and to build pipelines takes a process seconds, so that the
# suites of a folder below tests/NAME are one test, "PREFIX.FOLDER". Whole reconstructions stay tests of their own.
function(patina_test_suites TARGET NAME PREFIX LABEL)
    set(PROGRAM ${patina_BINARY_DIR}/${TARGET})
    set(FOLDER tests/${NAME})
    set(ENVIRONMENT ${ARGN})
    set(LEFT_OUT "^$")
    set(TESTS_LEFT_OUT "")
    set(FOLDERS ".")
    set(TESTS_TAKEN "*")
    set(WHOLE_FOLDERS ".")
    if(ENVIRONMENT)  # ctest begins with what takes long
        set(ALONE "${PATINA_WHOLE_SUITES}")
        set(COST_ALONE 1000)
        set(COST 100)
        if(NOT PATINA_TEST_FULL)
            set(TESTS_LEFT_OUT "-${PATINA_LONG_TESTS}")
        endif()
    else()
        set(ALONE ".")
        set(COST_ALONE 0)
        set(COST 0)
    endif()
    if(LABEL MATCHES "^(swiftshader|lavapipe128)$" AND NOT PATINA_TEST_FULL)
        set(LEFT_OUT "${PATINA_WHOLE_SUITES}")
    endif()
    if(LABEL STREQUAL swiftshader AND NOT PATINA_TEST_FULL)
        set(FOLDERS "${PATINA_SWIFTSHADER_FOLDERS}")
        set(WHOLE_FOLDERS "${PATINA_SWIFTSHADER_WHOLE_FOLDERS}")
        set(TESTS_TAKEN "${PATINA_COMPARING_TESTS}")
        string(APPEND TESTS_LEFT_OUT ":${PATINA_SWIFTSHADER_LONG_TESTS}")
    elseif(LABEL STREQUAL lavapipe128 AND NOT PATINA_TEST_FULL)
        set(TESTS_TAKEN "${PATINA_COMPARING_TESTS}")
        string(APPEND TESTS_LEFT_OUT ":${PATINA_LAVAPIPE128_LONG_TESTS}")
        set(WHOLE_FOLDERS "${PATINA_LAVAPIPE128_WHOLE_FOLDERS}")
    endif()
    set(DISCOVERY_FILE ${CMAKE_CURRENT_BINARY_DIR}/${TARGET}_${LABEL}_suites.cmake)
    configure_file(discover_suites.cmake.in ${DISCOVERY_FILE} @ONLY)
    set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${DISCOVERY_FILE})
endfunction()

# Registers a GoogleTest program once per driver, with the driver as label: without a filter by folders, as "NAME.DRIVER.FOLDER";
# with one every TEST by itself, as "NAME.DRIVER.Suite.Name".
#   DRIVERS   only these, instead of all
#   FILTER    only TESTs that this GoogleTest filter takes
#   LABELS    more labels
function(patina_test_on_drivers TARGET NAME)
    cmake_parse_arguments(ARG "" "FILTER" "DRIVERS;LABELS" ${ARGN})
    if(NOT ARG_DRIVERS)
        set(ARG_DRIVERS ${PATINA_DRIVERS})
    endif()
    foreach(DRIVER ${ARG_DRIVERS})
        if(NOT ARG_FILTER)
            patina_test_suites(${TARGET} ${NAME} ${NAME}.${DRIVER} ${DRIVER} ${PATINA_ENVIRONMENT_${DRIVER}})
            continue()
        endif()
        string(MAKE_C_IDENTIFIER "${TARGET}_${DRIVER}_${ARG_FILTER}" LIST)
        set(FILTER "${ARG_FILTER}")
        if(DRIVER MATCHES "^(swiftshader|lavapipe128)$" AND NOT PATINA_TEST_FULL)
            string(APPEND FILTER "-${PATINA_WHOLE_TESTS}")
        endif()
        gtest_discover_tests(${TARGET} TEST_PREFIX "${NAME}.${DRIVER}." TEST_LIST ${LIST} TEST_FILTER "${FILTER}"
                             DISCOVERY_MODE PRE_TEST)
        # The environment is a list, which gtest_discover_tests() cannot pass on; ctest sets it after discovery.
        set(ENVIRONMENT ${PATINA_ENVIRONMENT_${DRIVER}})
        set(LABELS ${DRIVER} ${ARG_LABELS})
        set(PROPERTIES_FILE ${CMAKE_CURRENT_BINARY_DIR}/${LIST}_properties.cmake)
        file(CONFIGURE OUTPUT ${PROPERTIES_FILE} @ONLY CONTENT
             "set_tests_properties(\${@LIST@} PROPERTIES LABELS \"@LABELS@\" ENVIRONMENT \"@ENVIRONMENT@\")\n")
        set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${PROPERTIES_FILE})
    endforeach()
endfunction()

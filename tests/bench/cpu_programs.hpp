// cpu_programs.hpp - the loops that the interpreters are timed with, in Intel assembly language.
// Depends on   the standard library.
#pragma once

#include <string_view>

namespace cpu_benchmark {

/// Register arithmetic, a 16-bit sum and a counted branch; no memory but the program.
inline constexpr std::string_view kCompute = R"(
        LXI  H,0
        LXI  D,1234H
        MVI  B,0
LOOP:   DAD  D
        MOV  A,L
        XRA  H
        ADD  D
        MOV  E,A
        MOV  A,H
        RLC
        ADI  35H
        MOV  D,A
        INR  B
        CMP  B
        DCR  C
        JNZ  LOOP
        JMP  LOOP
)";

/// Copies 1024 bytes and changes the source, again and again.
inline constexpr std::string_view kMemory = R"(
AGAIN:  LXI  H,8000H
        LXI  D,9000H
        LXI  B,0400H
LOOP:   MOV  A,M
        STAX D
        INX  H
        INX  D
        INR  M
        DCX  B
        MOV  A,B
        ORA  C
        JNZ  LOOP
        LHLD 8000H
        INX  H
        SHLD 8000H
        JMP  AGAIN
)";

/// Calls within calls, registers saved and restored.
inline constexpr std::string_view kCalls = R"(
        LXI  SP,0F000H
LOOP:   CALL INNER
        CALL OUTER
        MVI  A,3
        CALL TWICE
        JMP  LOOP
INNER:  PUSH B
        INX  B
        POP  B
        RET
OUTER:  PUSH H
        PUSH PSW
        CALL INNER
        POP  PSW
        POP  H
        RET
TWICE:  DCR  A
        RZ
        CALL TWICE
        RET
)";

/// On the board: the 100 Hz tick, a watchdog edge in its handler, and a computing main line.
inline constexpr std::string_view kBoardTick = R"(
        ORG  0
        JMP  START
        ORG  3CH
        JMP  TICK
        ORG  100H
START:  LXI  SP,0FF00H
        MVI  A,34H
        OUT  13H
        MVI  A,00H
        OUT  10H
        MVI  A,78H
        OUT  10H
        MVI  A,1BH
        SIM
        EI
        MVI  C,0
LOOP:   DAD  D
        MOV  A,L
        XRA  H
        ADD  D
        MOV  E,A
        DCR  C
        JNZ  LOOP
        JMP  LOOP
TICK:   PUSH PSW
        PUSH H
        LHLD 8000H
        INX  H
        SHLD 8000H
        MOV  A,L
        RRC
        ANI  80H
        ORI  40H
        SIM
        POP  H
        POP  PSW
        EI
        RET
)";

/// On the board: the same tick, and a main line that polls the USART and a parallel port without
/// pause.
inline constexpr std::string_view kBoardPoll = R"(
        ORG  0
        JMP  START
        ORG  3CH
        JMP  TICK
        ORG  100H
START:  LXI  SP,0FF00H
        MVI  A,34H
        OUT  13H
        MVI  A,00H
        OUT  10H
        MVI  A,78H
        OUT  10H
        MVI  A,56H
        OUT  13H
        MVI  A,10
        OUT  11H
        MVI  A,4EH
        OUT  09H
        MVI  A,05H
        OUT  09H
        MVI  A,1BH
        SIM
        EI
LOOP:   IN   09H
        ANI  01H
        JZ   BUSY
        MVI  A,55H
        OUT  08H
BUSY:   IN   21H
        ANI  40H
        JMP  LOOP
TICK:   PUSH PSW
        PUSH H
        LHLD 8000H
        INX  H
        SHLD 8000H
        MOV  A,L
        RRC
        ANI  80H
        ORI  40H
        SIM
        POP  H
        POP  PSW
        EI
        RET
)";

}  // namespace cpu_benchmark

; hello.asm - a CP/M program that adds 1 to 100 and prints the sum in decimal.
; Its instructions and T-states are counted by hand in cpm_programs_test.cpp: change both.
BDOS    EQU   5
        ORG   100H
        LXI   D,TEXT
        MVI   C,9
        CALL  BDOS
        LXI   H,0
        LXI   D,100
SUM:    DAD   D
        DCX   D
        MOV   A,D
        ORA   E
        JNZ   SUM
        LXI   D,-1000
        CALL  DIGIT
        LXI   D,-100
        CALL  DIGIT
        LXI   D,-10
        CALL  DIGIT
        MOV   A,L
        ADI   '0'
        MOV   E,A
        MVI   C,2
        CALL  BDOS
        LXI   D,NEWLIN
        MVI   C,9
        CALL  BDOS
        JMP   0

; Prints how often the power of ten, negative in DE, goes into HL, and leaves the rest in HL.
DIGIT:  MVI   B,'0'-1
NEXT:   INR   B
        DAD   D               ; carry: it went in
        JC    NEXT
        MOV   A,L             ; once too often
        SUB   E
        MOV   L,A
        MOV   A,H
        SBB   D
        MOV   H,A
        PUSH  H
        MOV   E,B
        MVI   C,2
        CALL  BDOS
        POP   H
        RET

TEXT:   DB    'The sum of 1 to 100 is $'
NEWLIN: DB    13,10,'$'
